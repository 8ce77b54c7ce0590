//! Pictures of a section: by themselves, or two with a slider between them and their difference beside.

use super::image;
use crate::report::chart::escape;
use crate::report::picture::Picture;

/// The pictures. Those called `x.before` and `x.after`, and `x.difference` if there is one, are shown together.
pub(super) fn gallery(section: &str, pictures: &[Picture]) -> String {
    let part = |group: &str, side: &str| pictures.iter().find(|it| it.name == format!("{group}.{side}"));
    let (mut html, mut open) = (String::new(), "");
    for picture in pictures {
        // The picture that opens the page is there already.
        if (section, picture.name.as_str()) == super::OPENING {
            continue;
        }
        match picture.name.rsplit_once('.') {
            None => {
                enter(&mut html, &mut open, "shots");
                html += &single(picture);
            }
            Some((group, "before")) => {
                let difference = part(group, "difference");
                // Without a difference there is room for two beside each other.
                let box_class = if difference.is_some() { "" } else { "twins" };
                enter(&mut html, &mut open, box_class);
                if let Some(after) = part(group, "after") {
                    html += &pair(picture, after, difference);
                }
            }
            Some(_) => {}
        }
    }
    enter(&mut html, &mut open, "");
    html
}

/// Closes the box that is open and opens that of another class, none for an empty one; nothing where it is the same.
fn enter(html: &mut String, open: &mut &'static str, class: &'static str) {
    if *open == class {
        return;
    }
    if !open.is_empty() {
        *html += "</div>\n";
    }
    if !class.is_empty() {
        *html += &format!("<div class=\"{class}\">\n");
    }
    *open = class;
}

fn single(picture: &Picture) -> String {
    let (title, rest) = split(&picture.caption);
    let class = if picture.format() == "png" { " class=\"pixels\"" } else { "" };
    format!("<figure{class}>{}<figcaption><b>{title}</b> {rest}</figcaption></figure>\n", image(picture, &picture.caption))
}

fn pair(before: &Picture, after: &Picture, difference: Option<&Picture>) -> String {
    // What stands at the sides is the first sentence of each caption; the rest is told below.
    let ((left, told), (right, more)) = (split(&before.caption), split(&after.caption));
    let slider = format!(
        "<div class=\"compare\">{}<img class=\"over\" {}<span class=\"bar\"></span><span class=\"side l\">{left}</span><span class=\"side \
         r\">{right}</span><input type=\"range\" min=\"0\" max=\"100\" value=\"50\" aria-label=\"{left} or {right}\"></div>",
        image(before, &before.caption),
        image(after, &after.caption).trim_start_matches("<img "),
    );
    let shown = match difference {
        Some(it) => format!("<div class=\"pair\"><div>{slider}</div><div>{}</div></div>", image(it, &it.caption)),
        None => slider,
    };
    let of_difference = difference.map_or_else(String::new, |it| format!(" {}", escape(&it.caption)));
    let two = if difference.is_some() { "" } else { " two" };
    format!("<figure class=\"triple{two}\">{shown}<figcaption>{told} {more}{of_difference}</figcaption></figure>\n")
}

/// The first sentence of a caption and the rest, escaped.
fn split(caption: &str) -> (String, String) {
    let (first, rest) = caption.split_once(". ").unwrap_or((caption.trim_end_matches('.'), ""));
    (escape(first), escape(rest))
}
