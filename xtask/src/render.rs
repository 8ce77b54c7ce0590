//! `cargo xtask render`: pictures into `out/`.

use crate::{Failure, cargo, finish, root};
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What to render when nothing is named.
const DEFAULT_SCENE: &str = "teapot";

/// The environment variable that names the folder of course data.
const COURSE_VARIABLE: &str = "GZ_HW_DATA";

/// The exit code of gz for a scene that cannot be used.
const BAD_SCENE: i32 = 3;

/// Renders the scene that the first argument names, the default one without; the rest goes to `gz render`.
pub(crate) fn run(arguments: &[String]) -> Result<(), Failure> {
    let (what, options) = split(arguments);
    let scenes = match what {
        "all" if names_output(options) => {
            return Err(Failure { message: "all scenes cannot go to one output".to_owned(), code: 2 });
        }
        "all" => known_scenes()?,
        one => vec![scene(one)?],
    };
    finish(cargo().args(["build", "--release", "--package", "gz-app", "--bin", "gz"]), "building gz")?;
    let (scenes, without) = if what == "all" { parted(scenes) } else { (scenes, Vec::new()) };
    if !without.is_empty() {
        println!("skipping {}: they need course data, see GZ_HW_DATA in README.md", without.join(", "));
    }
    // One that fails does not keep the others from being rendered.
    let failures: Vec<Failure> = scenes.iter().filter_map(|scene| render(scene, options).err()).collect();
    let Some(first) = failures.first() else { return Ok(()) };
    let messages: Vec<&str> = failures.iter().map(|failure| failure.message.as_str()).collect();
    Err(Failure { message: messages.join(", "), code: first.code })
}

/// What is to be rendered, and the options for gz behind it.
fn split(arguments: &[String]) -> (&str, &[String]) {
    match arguments.split_first() {
        Some((first, rest)) if !first.starts_with('-') => (first, rest),
        _ => (DEFAULT_SCENE, arguments),
    }
}

/// The scenes that can be rendered here, and the names of those that cannot for want of course data.
fn parted(scenes: Vec<PathBuf>) -> (Vec<PathBuf>, Vec<String>) {
    if std::env::var_os(COURSE_VARIABLE).is_some_and(|folder| !folder.is_empty()) {
        return (scenes, Vec::new()); // a file that is not in the folder is a failure
    }
    let (without, here): (Vec<_>, Vec<_>) = scenes.into_iter().partition(|scene| lacks_course_data(scene));
    (here, without.iter().map(|scene| stem(scene)).collect())
}

/// Whether gz refuses the scene for want of course data; a stand-in in the scene keeps it from doing so.
fn lacks_course_data(scene: &Path) -> bool {
    match gz().arg("info").arg(scene).output() {
        Ok(ended) => ended.status.code() == Some(BAD_SCENE) && asks_for_course_data(&String::from_utf8_lossy(&ended.stderr)),
        Err(_) => false, // rendering it tells why
    }
}

/// Whether this is gz's hint to set the variable.
fn asks_for_course_data(message: &str) -> bool {
    message.contains(&format!("set {COURSE_VARIABLE}"))
}

fn names_output(options: &[String]) -> bool {
    options.iter().any(|option| option.starts_with("-o") || option.starts_with("--output"))
}

/// The gz that was built.
fn gz() -> Command {
    let mut command = cargo();
    command.args(["run", "--quiet", "--release", "--package", "gz-app", "--bin", "gz", "--"]);
    command
}

fn render(scene: &Path, options: &[String]) -> Result<(), Failure> {
    let mut command = gz();
    // Paths among the options are meant from where the user stands, not from the workspace.
    let here = std::env::current_dir().unwrap_or_else(|_| root());
    command.current_dir(&here).arg("render");
    let shown = |path: &Path| path.strip_prefix(&here).unwrap_or(path).to_owned();
    let scene = shown(scene);
    command.arg(&scene).args(options);
    let mut picture = None;
    if !names_output(options) {
        let folder = root().join("out");
        std::fs::create_dir_all(&folder)
            .map_err(|error| Failure { message: format!("{}: cannot be made: {error}", folder.display()), code: 1 })?;
        let mut name = scene.file_stem().unwrap_or_default().to_owned();
        name.push(".png");
        picture = Some(shown(&folder.join(name)));
    }
    if let Some(picture) = &picture {
        command.arg("--output").arg(picture);
    }
    if !options.iter().any(|option| option.starts_with("--progress")) && !std::io::stderr().is_terminal() {
        command.args(["--progress", "plain"]);
    }
    println!("rendering {}", scene.display());
    finish(&mut command, &format!("rendering {}", scene.display()))?;
    if let Some(picture) = picture {
        println!("the picture is {}", picture.display());
    }
    Ok(())
}

/// A scene of `assets/scenes` by its stem, or a file as it is.
fn scene(name: &str) -> Result<PathBuf, Failure> {
    let file = PathBuf::from(name);
    if file.extension().is_some() {
        return Ok(file); // a missing file is gz's to report
    }
    let scenes = known_scenes()?;
    let known: Vec<String> = scenes.iter().map(|scene| stem(scene)).collect();
    match known.iter().position(|stem| stem == name) {
        Some(k) => Ok(scenes[k].clone()),
        None => Err(Failure { message: format!("no scene {name}: it is a file, all, or one of {}", known.join(", ")), code: 2 }),
    }
}

/// What a scene is called.
fn stem(scene: &Path) -> String {
    scene.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// The scene files of `assets/scenes`, by name.
fn known_scenes() -> Result<Vec<PathBuf>, Failure> {
    let folder = root().join("assets/scenes");
    let entries =
        std::fs::read_dir(&folder).map_err(|error| Failure { message: format!("{}: {error}", folder.display()), code: 1 })?;
    let mut scenes: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    scenes.retain(|path| path.extension().is_some_and(|e| e == "toml"));
    scenes.sort();
    Ok(scenes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_hint_counts_as_absent_course_data() {
        let hint = "gz: hw3.toml:21: \"hw:pot4.asc\" is course data: set GZ_HW_DATA to the folder of course data\n";
        assert!(asks_for_course_data(hint));
        assert!(!asks_for_course_data("gz: a.toml:5: no such file: pot.asc (GZ_HW_DATA must be the folder of course data)\n"));
    }

    #[test]
    fn the_scene_comes_first_and_may_be_left_out() {
        let words = |text: &str| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
        assert_eq!(split(&words("hw5 --size 10x10")), ("hw5", &words("--size 10x10")[..]));
        assert_eq!(split(&words("--size 10x10")), (DEFAULT_SCENE, &words("--size 10x10")[..]));
        assert_eq!(split(&[]), (DEFAULT_SCENE, &[][..]));
        assert!(names_output(&words("--depth 3 -o a.png")) && !names_output(&words("--depth 3")));
    }
}
