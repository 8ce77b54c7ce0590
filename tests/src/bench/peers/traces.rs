//! Tracing: every competitor on every set of rays, in turns.

use super::frame_rays;
use super::meshes::{Mesh, rays};
use super::options::Options;
use super::scaling;
use super::workshop::{Workshop, settings};
use crate::bench::record::Record;
use crate::bench::table::lines;
use crate::bench::timing::{Ratio, machine, median};
use crate::row;
use gz_app::error::AppError;
use std::process::{Command, Stdio};

/// Embree's fastest settings: packets for rays that go the same way, single rays for others.
const EMBREE: [&str; 3] = ["embree4:8-coh-f256", "embree4:16-coh-f512", "embree4:1-f256"];
/// Embree as it lets no ray slip between neighbouring triangles, as the others do now and then: the check on our answers.
const ROBUST: &str = "embree4:1-robust-f256";
/// The others.
const RIVALS: [&str; 3] = ["obvhs-cw-vslow", "obvhs-bvh2-vslow", "parry3d"];
/// The share of rays on which robust Embree may have another answer, as it computes in f32: a silhouette or a sliver here and there.
const MAY_DIFFER: f64 = 1e-4;

/// The same for the product's own rays, which Embree has with rounded origins.
const ROUNDED_MAY_DIFFER: f64 = 1e-3;

fn may_differ(set: &str) -> f64 {
    if frame_rays::SETS.contains(&set) { ROUNDED_MAY_DIFFER } else { MAY_DIFFER }
}

/// What one competitor did with one set of rays on one number of threads.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Lap {
    pub(super) name: String,
    pub(super) threads: usize,
    rays: usize,
    hits: usize,
    /// Rays with another answer than ours: hit for miss, or t off by more than 1e-4 of it.
    differing: usize,
    /// Seconds of the fastest turns together.
    best: f64,
    /// Seconds of each round; fewer for one that takes more than a second.
    pub(super) rounds: Vec<f64>,
}

impl Lap {
    /// A line of the race's output.
    pub(super) fn parse(line: &str) -> Option<Self> {
        let mut words = line.split_whitespace();
        let name = words.next()?.to_owned();
        let [threads, rays, hits, differing] =
            [words.next()?, words.next()?, words.next()?, words.next()?].map(|word| word.parse().ok());
        let seconds: Vec<f64> = words.map(str::parse).collect::<Result<_, _>>().ok()?;
        let (&best, rounds) = seconds.split_first()?;
        let sound = best > 0.0 && !rounds.is_empty();
        let rounds = rounds.to_vec();
        sound.then_some(Self { name, threads: threads?, rays: rays?, hits: hits?, differing: differing?, best, rounds })
    }

    /// Millions of rays a second in the fastest turns.
    fn speed(&self) -> f64 {
        self.rays as f64 / self.best / 1e6
    }
}

/// All competitors on one set of rays and one number of threads; the first is ours.
pub(super) struct Heat<'m> {
    pub(super) mesh: &'m Mesh,
    pub(super) set: &'m str,
    pub(super) threads: usize,
    pub(super) laps: Vec<Lap>,
}

impl Heat<'_> {
    pub(super) fn ours(&self) -> &Lap {
        &self.laps[0]
    }

    /// The fastest of Embree's settings.
    pub(super) fn best_embree(&self) -> Option<&Lap> {
        self.laps.iter().filter(|lap| EMBREE.contains(&lap.name.as_str())).min_by(|a, b| a.best.total_cmp(&b.best))
    }

    /// How many times our speed is Embree's, by rounds.
    fn ratio(&self, embree: &Lap) -> Ratio {
        Ratio::of(&embree.rounds, &self.ours().rounds)
    }
}

/// Races on all meshes and sets and prints the table.
///
/// # Errors
///
/// If the race fails, or robust Embree has other answers than we have on more than a few rays.
pub(super) fn run(workshop: &Workshop, options: &Options, meshes: &[Mesh]) -> Result<(), AppError> {
    let competitors: Vec<String> = std::iter::once(format!("{}:default", workshop.ours.display()))
        .chain(EMBREE.iter().chain([&ROBUST]).map(|name| name.replace("embree4", &workshop.embree.display().to_string())))
        .chain(RIVALS.iter().map(|variant| format!("{}:{variant}", workshop.rivals.display())))
        .collect();
    let threads = if options.threads.is_empty() { vec![1] } else { options.threads.clone() };
    println!("{}", machine(threads[0]));
    let list = threads.iter().map(ToString::to_string).collect::<Vec<_>>().join(",");
    let mut heats = Vec::new();
    for mesh in meshes {
        for set in &options.sets {
            let rays = rays(workshop, mesh, set)?;
            let mut race = Command::new(&workshop.race);
            race.arg("trace").arg(&mesh.path).arg(rays).arg(set).args([&list, &options.rounds.to_string()]).args(&competitors);
            println!("{}, {set}, threads: {list}", mesh.name);
            let laps = laps(&mut race, competitors.len() * threads.len())?;
            let of = |(&threads, laps): (&usize, &[Lap])| Heat { mesh, set, threads, laps: laps.to_vec() };
            heats.extend(threads.iter().zip(laps.chunks(competitors.len())).map(of));
        }
    }
    // By number of threads, as the table is read.
    heats.sort_by_key(|heat| threads.iter().position(|&n| n == heat.threads));
    print_table(&heats);
    print!("{}", scaling::table(&heats, &threads));
    if options.write {
        Record::new("peers", options.rounds, &settings())?
            .write(HEAD, heats.iter().flat_map(|heat| heat.laps.iter().map(|lap| cells(heat, lap))))?;
    }
    let mut robust = heats.iter().filter_map(|heat| Some((heat, heat.laps.iter().find(|lap| lap.name == ROBUST)?)));
    match robust.find(|(heat, lap)| lap.differing as f64 > may_differ(heat.set) * lap.rays as f64) {
        Some((heat, lap)) => Err(AppError::Differs(format!(
            "{} of {} answers to {} {} differ between robust Embree and us",
            lap.differing, lap.rays, heat.mesh.name, heat.set
        ))),
        None => Ok(()),
    }
}

/// What the race prints, a lap a competitor.
fn laps(race: &mut Command, expected: usize) -> Result<Vec<Lap>, AppError> {
    let output =
        race.stderr(Stdio::inherit()).output().map_err(|error| AppError::Io(format!("the race cannot be started: {error}")))?;
    let laps: Option<Vec<Lap>> = String::from_utf8_lossy(&output.stdout).lines().map(Lap::parse).collect();
    match laps {
        Some(laps) if output.status.success() && laps.len() == expected => Ok(laps),
        _ => Err(AppError::Io("the race failed".to_owned())),
    }
}

fn print_table(heats: &[Heat<'_>]) {
    let Some(first) = heats.first() else { return };
    let mut head = row!["mesh", "set", "threads"];
    head.extend(
        first.laps.iter().map(|lap| lap.name.replace("rs_peers:", "").replace("embree4:", "Embree ").replace(":default", "")),
    );
    head.extend(row!["gz to best Embree [95% interval]", "differ from gz"]);
    let mut rows = vec![head];
    let (mut logs, mut answers) = (Vec::new(), 0);
    for heat in heats {
        let mut row = row![heat.mesh.name, heat.set, heat.threads];
        row.extend(heat.laps.iter().map(|lap| format!("{:.2}", lap.speed())));
        row.push(heat.best_embree().map_or_else(|| "-".to_owned(), |embree| heat.ratio(embree).to_string()));
        let differing: Vec<String> = heat.laps[1..].iter().map(|lap| lap.differing.to_string()).collect();
        row.push(differing.join(" "));
        rows.push(row);
        logs.extend(heat.best_embree().map(|embree| heat.ratio(embree).mean.ln()));
        answers += heat.laps[1..].iter().map(|lap| lap.rays).sum::<usize>();
    }
    println!(
        "\nMrays/s of the fastest turns; the ratio is of speeds, by rounds, to the fastest of Embree's settings in that row"
    );
    print!("{}", lines(&rows));
    println!("differ: in the order of the columns behind gz, whose answers are exact; {answers} answers compared");
    let mean = logs.iter().sum::<f64>() / logs.len() as f64;
    println!("geometric mean of the {} ratios: {:.3}x", logs.len(), mean.exp());
}

/// Columns of the record.
const HEAD: &str = "mesh,triangles,set,threads,competitor,rays,hits,differ,Mrays/s best,Mrays/s median,seconds by round";

fn cells(heat: &Heat<'_>, lap: &Lap) -> Vec<String> {
    let rounds: Vec<String> = lap.rounds.iter().map(|s| format!("{s:.6}")).collect();
    row![
        heat.mesh.name,
        heat.mesh.triangles,
        heat.set,
        heat.threads,
        lap.name,
        lap.rays,
        lap.hits,
        lap.differing,
        format!("{:.3}", lap.speed()),
        format!("{:.3}", lap.rays as f64 / median(&lap.rounds) / 1e6),
        rounds.join(" "),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_of_the_race_is_a_lap() {
        let lap = Lap::parse("embree4:1-f256 2 2000000 3 1 0.5 0.6 0.7").unwrap();
        assert_eq!((lap.name.as_str(), lap.threads, lap.hits, lap.differing), ("embree4:1-f256", 2, 3, 1));
        assert_eq!(lap.speed(), 4.0);
        assert_eq!(lap.rounds, [0.6, 0.7]);
        for bad in [
            "",
            "gz:default 1 1 2",
            "gz:default 1 1 2 3 0.5",
            "gz:default 1 1 2 3 x 0.5",
            "gz:default 1 -1 2 3 0.5 0.5",
            "gz 1 1 2 3 0 1",
        ] {
            assert_eq!(Lap::parse(bad), None, "{bad}");
        }
    }

    #[test]
    fn ours_is_set_against_the_fastest_embree() {
        let mesh = Mesh { name: "m".to_owned(), path: "m.trim".into(), triangles: 1 };
        let lap = |line| Lap::parse(line).unwrap();
        let laps = vec![
            lap("gz:default 1 10 1 0 1.0 1.0 1.0"),
            lap("embree4:1-f256 1 10 1 0 2.0 2.0 2.0"),
            lap("embree4:16-coh-f512 1 10 1 0 0.5 0.5 0.5"),
            lap("embree4:1-robust-f256 1 10 1 0 0.2 0.2 0.2"),
            lap("rs_peers:parry3d 1 10 1 0 0.1 0.1 0.1"),
        ];
        let heat = Heat { mesh: &mesh, set: "random", threads: 1, laps };
        let embree = heat.best_embree().unwrap();
        assert_eq!(embree.name, "embree4:16-coh-f512");
        assert!((heat.ratio(embree).mean - 0.5).abs() < 1e-12);
    }
}
