//! How much faster several threads are than the first number of threads, everybody against their own time in the same race.

use super::traces::Heat;
use crate::bench::table::lines;
use crate::bench::timing::Ratio;
use crate::row;

/// What we are to reach of Embree's own scaling.
const GOAL: f64 = 0.95;

/// A row for each mesh, set and number of threads beyond the first; nothing for a single number of threads.
pub(super) fn table(heats: &[Heat<'_>], threads: &[usize]) -> String {
    let Some((&first, more)) = threads.split_first() else { return String::new() };
    let find = |like: &Heat<'_>, threads: usize| {
        heats.iter().find(|heat| heat.mesh.name == like.mesh.name && heat.set == like.set && heat.threads == threads)
    };
    let (mut rows, mut reached) = (Vec::new(), Vec::new());
    for many in heats.iter().filter(|heat| more.contains(&heat.threads)) {
        let Some(one) = find(many, first) else { continue };
        if rows.is_empty() {
            let mut head = row!["mesh", "set", "threads"];
            head.extend(
                many.laps
                    .iter()
                    .map(|lap| lap.name.replace("rs_peers:", "").replace("embree4:", "Embree ").replace(":default", "")),
            );
            head.push("gz's share of the best Embree's [95% interval]".to_owned());
            rows.push(head);
        }
        let mut row = row![many.mesh.name, many.set, format!("{first} to {}", many.threads)];
        row.extend(one.laps.iter().zip(&many.laps).map(|(a, b)| format!("{:.2}", Ratio::of(&a.rounds, &b.rounds).mean)));
        let share = share(one, many);
        row.push(share.map_or_else(|| "-".to_owned(), |share| share.to_string()));
        reached.extend(share.map(|share| share.mean >= GOAL));
        rows.push(row);
    }
    if rows.is_empty() {
        return String::new();
    }
    let count = reached.iter().filter(|&&is| is).count();
    format!(
        "\nscaling: the time on {first} threads by that on more, by rounds\n{}gz scales at least {:.0}% as well as Embree in {count} of {} rows\n",
        lines(&rows),
        100.0 * GOAL,
        reached.len()
    )
}

/// Our scaling by that of Embree in the setting that is fastest on the larger number of threads, round by round.
fn share(one: &Heat<'_>, many: &Heat<'_>) -> Option<Ratio> {
    let theirs = many.best_embree()?;
    let before = one.laps.iter().find(|lap| lap.name == theirs.name)?;
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).collect::<Vec<f64>>();
    Some(Ratio::of(&product(&one.ours().rounds, &theirs.rounds), &product(&many.ours().rounds, &before.rounds)))
}

#[cfg(test)]
mod tests {
    use super::super::meshes::Mesh;
    use super::super::traces::Lap;
    use super::*;

    #[test]
    fn our_scaling_is_set_against_that_of_the_fastest_embree() {
        let mesh = Mesh { name: "m".to_owned(), path: "m.trim".into(), triangles: 1 };
        let lap = |line: &str| Lap::parse(line).unwrap();
        let heat = |threads, laps| Heat { mesh: &mesh, set: "random", threads, laps };
        let one = heat(
            1,
            vec![
                lap("gz:default 1 10 1 0 1.0 1.0 1.5"),
                lap("embree4:1-f256 1 10 1 0 2.0 2.0 3.0"),
                lap("embree4:8-coh-f256 1 10 1 0 9.0 9.0 9.0"),
            ],
        );
        let two = heat(
            2,
            vec![
                lap("gz:default 2 10 1 0 0.6 0.625 0.9375"),
                lap("embree4:1-f256 2 10 1 0 1.0 1.0 1.5"),
                lap("embree4:8-coh-f256 2 10 1 0 9.0 9.0 9.0"),
            ],
        );
        // 1.6 by 2.0.
        let share = share(&one, &two).unwrap();
        assert!((share.mean - 0.8).abs() < 1e-9, "{share}");
        let text = table(&[one, two], &[1, 2]);
        for part in ["1 to 2", "1.60", "2.00", "1.00", "0.80x", "at least 95% as well as Embree in 0 of 1 rows"] {
            assert!(text.contains(part), "{part} in {text}");
        }
        assert_eq!(table(&[], &[1]), "");
    }
}
