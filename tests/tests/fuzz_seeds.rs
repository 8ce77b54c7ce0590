//! The fuzz targets over their seeds: hard cases as bytes, random ones, and whatever once crashed.

use gz_tests::fuzz::seeds::{self, Seed, folder};
use gz_tests::fuzz::{build_tree, filter_soundness, trace};
use gz_tests::hard::Dice;
use std::path::PathBuf;

fn run(target: &str, body: fn(&[u8])) {
    let folder = folder(target);
    let entries = std::fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.expect("a readable folder").path()).collect();
    files.sort();
    assert!(files.len() >= 12, "{}: {} seeds", folder.display(), files.len());
    for file in &files {
        println!("{}", file.display()); // shown when the target panics
        body(&std::fs::read(file).expect("a readable seed"));
    }
    // And random bytes of all lengths.
    let mut dice = Dice::new(1);
    for length in 0..400 {
        let bytes: Vec<u8> = (0..length).map(|_| dice.bits() as u8).collect();
        body(&bytes);
    }
}

#[test]
fn trace_holds() {
    run("trace", trace);
}

#[test]
fn filter_soundness_holds() {
    run("filter_soundness", filter_soundness);
}

#[test]
fn build_tree_holds() {
    run("build_tree", build_tree);
}

#[test]
fn the_seeds_are_those_that_the_command_writes() {
    let seeds = seeds::all();
    assert!(seeds.len() >= 50, "{}", seeds.len());
    for Seed { target, name, bytes } in seeds {
        let file = folder(target).join(&name);
        let there = std::fs::read(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        assert!(there == bytes, "{}: cargo xtask seeds writes other bytes", file.display());
    }
}
