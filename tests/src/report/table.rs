//! Rows of figures with typed columns: what is measured, kept in files, drawn and printed.

/// What the figures of a column are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Words that name a row; together they tell rows apart.
    Label,
    /// Words that say more.
    Note,
    /// Whole numbers that follow from seed and settings.
    Count,
    /// Other numbers that follow from seed and settings.
    Figure,
    /// Numbers that hold for one machine and one run.
    Time,
}

impl Kind {
    /// Whether a run with the same seed and settings gives the same to the bit.
    pub fn is_repeatable(self) -> bool {
        self != Self::Time
    }
}

/// A column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Column {
    /// Its name in files.
    pub name: &'static str,
    /// Its name on the page.
    pub title: &'static str,
    /// The unit, empty for words and pure numbers.
    pub unit: &'static str,
    /// What its figures are.
    pub kind: Kind,
}

impl Column {
    /// A column.
    pub const fn new(name: &'static str, title: &'static str, unit: &'static str, kind: Kind) -> Self {
        Self { name, title, unit, kind }
    }

    /// Its title with the unit.
    pub fn head(&self) -> String {
        if self.unit.is_empty() { self.title.to_owned() } else { format!("{}, {}", self.title, self.unit) }
    }
}

/// A cell.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// Words.
    Text(String),
    /// A number.
    Number(f64),
    /// Nothing is known, or nothing makes sense.
    Missing,
}

impl Cell {
    /// As files have it: numbers so that reading them gives the same bits.
    pub fn text(&self) -> String {
        match self {
            Self::Text(text) => text.clone(),
            Self::Number(number) => number.to_string(),
            Self::Missing => String::new(),
        }
    }

    /// From the text of a file.
    pub fn parse(text: &str, kind: Kind) -> Option<Self> {
        match kind {
            Kind::Label | Kind::Note => Some(Self::Text(text.to_owned())),
            _ if text.is_empty() => Some(Self::Missing),
            _ => text.parse().ok().map(Self::Number),
        }
    }

    /// As the page has it: numbers with three digits, counts whole.
    pub fn shown(&self, kind: Kind) -> String {
        match self {
            Self::Text(text) => text.clone(),
            Self::Number(number) if kind == Kind::Count => grouped(*number),
            Self::Number(number) => short(*number),
            Self::Missing => "–".to_owned(),
        }
    }

    /// The number, if it is one.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(number) => Some(*number),
            _ => None,
        }
    }
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl From<f64> for Cell {
    fn from(number: f64) -> Self {
        if number.is_finite() { Self::Number(number) } else { Self::Missing }
    }
}

impl From<u64> for Cell {
    fn from(number: u64) -> Self {
        Self::Number(number as f64)
    }
}

impl From<usize> for Cell {
    fn from(number: usize) -> Self {
        Self::Number(number as f64)
    }
}

impl From<u32> for Cell {
    fn from(number: u32) -> Self {
        Self::Number(f64::from(number))
    }
}

impl<T: Into<Cell>> From<Option<T>> for Cell {
    fn from(cell: Option<T>) -> Self {
        cell.map_or(Self::Missing, Into::into)
    }
}

/// The cells of a row from things that can be one.
#[macro_export]
macro_rules! cells {
    ($($cell:expr),* $(,)?) => { vec![$($crate::report::table::Cell::from($cell)),*] };
}

/// A row.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// One for each column.
    pub cells: Vec<Cell>,
    /// How many rays, pixels or cases it stands on.
    pub n: u64,
    /// What it was measured with.
    pub settings: String,
}

/// Rows under their columns.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// The columns.
    pub columns: Vec<Column>,
    /// The rows.
    pub rows: Vec<Row>,
}

impl Table {
    /// The number of the column of this name.
    pub fn column(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column.name == name)
    }

    /// The number in row `row` under the column `name`.
    pub fn number(&self, row: usize, name: &str) -> Option<f64> {
        self.rows.get(row)?.cells[self.column(name)?].number()
    }

    /// The words in row `row` under the column `name`; empty if there are none.
    pub fn words(&self, row: usize, name: &str) -> &str {
        let cell = self.column(name).and_then(|k| self.rows.get(row).map(|row| &row.cells[k]));
        if let Some(Cell::Text(text)) = cell { text } else { "" }
    }

    /// The first row that has these words under the column `name`.
    pub fn row(&self, name: &str, words: &str) -> Option<usize> {
        (0..self.rows.len()).find(|&row| self.words(row, name) == words)
    }

    /// What names row `row`: its labels, joined.
    pub fn label(&self, row: usize) -> String {
        let labels = self.columns.iter().zip(&self.rows[row].cells).filter(|(column, _)| column.kind == Kind::Label);
        labels.map(|(_, cell)| cell.text()).collect::<Vec<_>>().join(", ")
    }

    /// The labels of all rows.
    pub fn labels(&self) -> Vec<String> {
        (0..self.rows.len()).map(|row| self.label(row)).collect()
    }
}

/// Three digits, with an exponent where zeros would hide them.
pub fn short(x: f64) -> String {
    let size = x.abs();
    if x == 0.0 {
        "0".to_owned()
    } else if !(1e-3..1e6).contains(&size) {
        format!("{x:.2e}")
    } else {
        // The digits of the rounded number, so that 9.996 becomes 10.0 and not 10.00.
        let digits = format!("{size:.2e}").split_once('e').and_then(|(_, e)| e.parse::<i32>().ok()).unwrap_or(0);
        let decimals = (2 - digits).max(0) as usize;
        if decimals == 0 { grouped(x.round()) } else { format!("{x:.decimals$}") }
    }
}

/// A whole number with a narrow space at thousands, from 10 000 on.
pub fn grouped(x: f64) -> String {
    let plain = format!("{:.0}", x.abs());
    let sign = if x < 0.0 { "-" } else { "" };
    if plain.len() < 5 {
        return format!("{sign}{plain}");
    }
    let mut text = String::new();
    for (k, digit) in plain.chars().enumerate() {
        if k > 0 && (plain.len() - k).is_multiple_of(3) {
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    format!("{sign}{text}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_shown_with_three_digits_and_counts_whole() {
        let shown = [0.0, 1.0, 9.996, 123.4, 1234.0, 12345.0, 0.01234, 1.5e-5, 2e9, -0.5].map(short);
        assert_eq!(
            shown,
            ["0", "1.00", "10.0", "123", "1234", "12\u{202f}345", "0.0123", "1.50e-5", "2.00e9", "-0.500"].map(str::to_owned)
        );
        assert_eq!(Cell::from(1_234_567u64).shown(Kind::Count), "1\u{202f}234\u{202f}567");
        assert_eq!(Cell::from(f64::INFINITY), Cell::Missing);
    }

    #[test]
    fn every_number_survives_its_text() {
        for x in [0.1, 1.0 / 3.0, 1e300, 5e-324, 123_456_789.0] {
            assert_eq!(Cell::parse(&Cell::from(x).text(), Kind::Figure), Some(Cell::Number(x)));
        }
        assert_eq!(Cell::parse("", Kind::Time), Some(Cell::Missing));
        assert_eq!(Cell::parse("x", Kind::Count), None);
    }
}
