//! The page: one HTML file with everything inside.

mod gallery;
mod tables;

use super::base64::base64;
use super::chart::{chart, escape};
use super::findings::Finding;
use super::picture::Picture;
use super::section::{Chapter, ChartSpec, Section};
use super::store::Origin;
use super::table::Table;
use std::fmt::Write;

pub use tables::{PageTable, tables_of};

const STYLE: &str = include_str!("style.css");
const SCRIPT: &str = include_str!("script.js");

/// A section with what was measured for it.
#[derive(Clone)]
pub struct Filled {
    /// The section.
    pub section: Section,
    /// Its rows.
    pub table: Table,
    /// Its pictures.
    pub pictures: Vec<Picture>,
}

/// What the page is made from.
pub struct Content {
    /// Where the rows come from.
    pub origin: Origin,
    /// How much was measured: the mode's name.
    pub mode: String,
    /// The sections.
    pub sections: Vec<Filled>,
    /// The findings.
    pub findings: Vec<Finding>,
}

/// The picture that opens the page, by section and name.
pub const OPENING: (&str, &str) = ("steps", "teapot");

/// The page. It asks for nothing from elsewhere.
pub fn page(content: &Content) -> String {
    let mut html = format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width, \
         initial-scale=1\">\n<title>gz: speed against error</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n"
    );
    html += &hero(content);
    html += &findings(&content.findings);
    let chapters: Vec<Chapter> =
        Chapter::ALL.into_iter().filter(|chapter| content.sections.iter().any(|it| it.section.chapter == *chapter)).collect();
    let links: String =
        chapters.iter().map(|chapter| format!("<a href=\"#{}\">{}</a>", name(*chapter), chapter.short())).collect();
    // Writing to a string cannot fail.
    let _ = write!(html, "<nav><div class=\"wrap\">{links}</div></nav>\n<main>\n");
    for chapter in chapters {
        let _ = write!(
            html,
            "<section class=\"chapter\" id=\"{}\"><div class=\"wrap\">\n<h2>{}</h2>\n<p class=\"about\">{}</p>\n",
            name(chapter),
            escape(chapter.title()),
            escape(chapter.about())
        );
        for filled in content.sections.iter().filter(|it| it.section.chapter == chapter) {
            html += &section(filled);
        }
        html += "</div></section>\n";
    }
    html += "</main>\n";
    html += &footer(content);
    let _ = write!(html, "<script>\n{SCRIPT}</script>\n</body>\n</html>\n");
    html
}

/// A chapter's name in links.
fn name(chapter: Chapter) -> String {
    format!("{chapter:?}").to_lowercase()
}

fn hero(content: &Content) -> String {
    let (section, picture) = OPENING;
    let found = content.sections.iter().find(|it| it.section.id == section);
    let found = found.and_then(|it| it.pictures.iter().find(|it| it.name == picture));
    let figure = found.map_or_else(String::new, |it| {
        format!("<figure>{}<figcaption>{}</figcaption></figure>", image(it, &it.caption), escape(&it.caption))
    });
    format!(
        "<header class=\"hero\"><div class=\"wrap\"><div>\n<div class=\"tag\">gz, a ray tracer for triangles</div>\n<h1>Speed against \
         error</h1>\n<p>Which triangle does a ray hit first? Asked in exact arithmetic the question has one answer. This page measures \
         how often the usual ways to ask it give another, what each costs, and what it costs to be right every time.</p>\n<p>Every \
         figure below stands in a table, every table in a file beside this page, and one command makes all of it again.</p>\n</div>\n\
         {figure}\n</div></header>\n"
    )
}

fn findings(findings: &[Finding]) -> String {
    if findings.is_empty() {
        return String::new();
    }
    let cards: String = findings
        .iter()
        .map(|it| {
            format!(
                "<div class=\"card\" id=\"finding-{}\"><div class=\"tag\">{}</div><div class=\"big\">{}</div>\n<h3>{}</h3>\n<p>{}</p></div>\n",
                it.id,
                escape(it.question),
                it.big,
                it.headline,
                it.text
            )
        })
        .collect();
    format!(
        "<section class=\"findings\"><div class=\"wrap\"><h2>Three findings</h2>\n<div class=\"cards\">\n{cards}</div></div></section>\n"
    )
}

fn section(filled: &Filled) -> String {
    let Filled { section, table, pictures } = filled;
    let mut html = format!("<h3 id=\"{}\">{}</h3>\n<p class=\"how\">{}</p>\n", section.id, escape(section.title), section.how);
    html += &gallery::gallery(section.id, pictures);
    for spec in section.charts {
        html += &figure(spec, table);
    }
    let says = (section.says)(table);
    if !says.is_empty() {
        let _ = writeln!(html, "<p class=\"says\">{says}</p>");
    }
    html + &tables::table(section, table)
}

fn figure(spec: &ChartSpec, table: &Table) -> String {
    let drawn = chart(spec, table);
    if drawn.is_empty() {
        return String::new();
    }
    format!(
        "<figure class=\"chart\"><h4>{}</h4>\n<p class=\"caption\">{}</p>\n{drawn}</figure>\n",
        escape(spec.title),
        escape(spec.caption)
    )
}

fn footer(content: &Content) -> String {
    let Origin { seed, revision, cpu } = &content.origin;
    let mode = &content.mode;
    format!(
        "<footer><div class=\"wrap\">\n<p>Measured with <code>cargo xtask report --{mode} --seed {seed}</code> on revision {}.<br>{}</p>\n\
         <p>Errors follow from the seed and come out the same everywhere; times hold for this machine and this run. Rows say how many \
         rays, pixels or cases they stand on (n). Where nothing was seen in n, the rate is below 3/n with 95% confidence. Pictures are \
         of our own scenes.</p>\n</div></footer>\n",
        escape(revision),
        escape(cpu)
    )
}

/// A picture as an element.
fn image(picture: &Picture, alt: &str) -> String {
    format!(
        "<img width=\"{}\" height=\"{}\" alt=\"{}\" src=\"data:image/{};base64,{}\">",
        picture.width,
        picture.height,
        escape(alt),
        picture.format(),
        base64(&picture.bytes)
    )
}

/// A page without the content of its pictures, to be compared with another.
pub fn without_pictures(page: &str) -> String {
    let mut parts = page.split(";base64,");
    let mut text =
        parts.next().unwrap_or_default().trim_end_matches("data:image/png").trim_end_matches("data:image/jpeg").to_owned();
    for part in parts {
        let rest = part.split_once('"').map_or("", |(_, rest)| rest);
        text.push('"');
        text += rest.trim_end_matches("data:image/png").trim_end_matches("data:image/jpeg");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_are_left_out_and_nothing_else() {
        let page = "<p>a</p><img src=\"data:image/png;base64,AAAA\"><b>c</b><img src=\"data:image/jpeg;base64,BB=\">d";
        assert_eq!(without_pictures(page), "<p>a</p><img src=\"\"><b>c</b><img src=\"\">d");
        assert_eq!(without_pictures("plain"), "plain");
    }
}
