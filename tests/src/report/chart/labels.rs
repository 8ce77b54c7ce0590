//! Where the words beside points stand, so that they cover neither points nor each other.

/// A rectangle in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rect {
    /// Left edge.
    pub(super) x0: f64,
    /// Upper edge.
    pub(super) y0: f64,
    /// Right edge.
    pub(super) x1: f64,
    /// Lower edge.
    pub(super) y1: f64,
}

impl Rect {
    fn overlap(&self, other: &Self) -> f64 {
        let width = self.x1.min(other.x1) - self.x0.max(other.x0);
        let height = self.y1.min(other.y1) - self.y0.max(other.y0);
        if width > 0.0 && height > 0.0 { width * height } else { 0.0 }
    }

    fn is_in(&self, other: &Self) -> bool {
        self.x0 >= other.x0 && self.x1 <= other.x1 && self.y0 >= other.y0 && self.y1 <= other.y1
    }
}

/// Height of a line of words.
const HEIGHT: f64 = 13.0;
/// Width of an average character.
const WIDTH: f64 = 7.6;
/// Half of what a point covers.
const POINT: f64 = 6.0;

/// About how wide words are in the chart's type.
pub(super) fn width_of(text: &str) -> f64 {
    text.chars().count() as f64 * WIDTH
}

/// Places a label beside each of `points`; `None` for one that finds no room. What is returned is the label's rectangle.
pub(super) fn place(points: &[(f64, f64, &str)], area: &Rect) -> Vec<Option<Rect>> {
    let around = |x: f64, y: f64| Rect { x0: x - POINT, y0: y - POINT, x1: x + POINT, y1: y + POINT };
    let mut taken: Vec<Rect> = points.iter().map(|&(x, y, _)| around(x, y)).collect();
    let mut placed = Vec::with_capacity(points.len());
    for &(x, y, text) in points {
        let width = width_of(text);
        // To the right first, as one reads; then around, near and a little farther.
        let candidates = [10.0, 16.0, 26.0].into_iter().flat_map(|far: f64| {
            let slant = far * 0.75;
            [
                (x + far, y - HEIGHT / 2.0),
                (x - far - width, y - HEIGHT / 2.0),
                (x - width / 2.0, y - far - HEIGHT + 4.0),
                (x - width / 2.0, y + far - 4.0),
                (x + slant, y - slant - HEIGHT / 2.0),
                (x + slant, y + slant - HEIGHT / 2.0),
                (x - slant - width, y - slant - HEIGHT / 2.0),
                (x - slant - width, y + slant - HEIGHT / 2.0),
            ]
        });
        let free = candidates
            .map(|(x0, y0)| Rect { x0, y0, x1: x0 + width, y1: y0 + HEIGHT })
            .find(|rect| !text.is_empty() && rect.is_in(area) && taken.iter().all(|other| rect.overlap(other) == 0.0));
        taken.extend(free);
        placed.push(free);
    }
    placed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_overlap_nothing_and_stay_inside() {
        let area = Rect { x0: 0.0, y0: 0.0, x1: 400.0, y1: 300.0 };
        let points: Vec<(f64, f64, &str)> =
            (0..12).map(|k| (150.0 + 9.0 * f64::from(k), 150.0 + 5.0 * f64::from(k % 4), "a long label")).collect();
        let placed = place(&points, &area);
        assert!(placed.iter().flatten().count() >= 4, "{placed:?}");
        for (k, rect) in placed.iter().enumerate().filter_map(|(k, rect)| Some((k, (*rect)?))) {
            assert!(rect.is_in(&area));
            assert!(placed.iter().enumerate().all(|(other, it)| other == k || it.is_none_or(|it| it.overlap(&rect) == 0.0)));
            assert!(points.iter().all(|&(x, y, _)| !(rect.x0 < x && x < rect.x1 && rect.y0 < y && y < rect.y1)));
        }
        assert_eq!(place(&[(395.0, 150.0, "far right")], &area)[0].map(|rect| rect.x1 < 395.0), Some(true));
        assert_eq!(place(&[(5.0, 5.0, "")], &area), [None]);
    }
}
