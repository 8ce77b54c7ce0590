//! Tiles: the parts of a picture that are worked on at a time.

/// A rectangle of pixels, half-open: columns `x0..x1`, rows `y0..y1` from the top.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tile {
    /// First column.
    pub x0: u32,
    /// First row.
    pub y0: u32,
    /// One beyond the last column.
    pub x1: u32,
    /// One beyond the last row.
    pub y1: u32,
}

impl Tile {
    /// Width in pixels.
    pub fn width(&self) -> u32 {
        self.x1 - self.x0
    }

    /// Height in pixels.
    pub fn height(&self) -> u32 {
        self.y1 - self.y0
    }

    /// The number of pixels.
    pub fn len(&self) -> usize {
        self.width() as usize * self.height() as usize
    }

    /// Whether there is no pixel.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// (column, row) of each pixel, row by row.
    pub fn pixels(&self) -> impl Iterator<Item = (u32, u32)> + use<> {
        let tile = *self;
        (tile.y0..tile.y1).flat_map(move |j| (tile.x0..tile.x1).map(move |i| (i, j)))
    }

    /// (column, row) of each pixel, square by square of eight by eight and in these of four by four: the order in which rays are traced, as
    /// neighbours go the same way.
    pub fn in_squares(&self) -> impl Iterator<Item = (u32, u32)> + use<> {
        let squares = TileGrid::of(*self, 8).into_tiles().flat_map(|square| TileGrid::of(square, 4).into_tiles());
        squares.flat_map(|square| square.pixels())
    }
}

/// A rectangle cut into square tiles; the last column and row may be smaller.
#[derive(Clone, Copy, Debug)]
pub struct TileGrid {
    area: Tile,
    size: u32,
}

impl TileGrid {
    /// Cuts a picture of `width` by `height` into tiles of `size` by `size`; a `size` of 0 counts as 1.
    pub fn whole(width: u32, height: u32, size: u32) -> Self {
        Self::of(Tile { x0: 0, y0: 0, x1: width, y1: height }, size)
    }

    /// Cuts `area` into tiles of `size` by `size`, beginning at its own corner; a `size` of 0 counts as 1.
    pub fn of(area: Tile, size: u32) -> Self {
        Self { area, size: size.max(1) }
    }

    /// What is cut.
    pub fn area(&self) -> Tile {
        self.area
    }

    /// The number of tiles.
    pub fn len(&self) -> usize {
        self.columns() as usize * self.area.height().div_ceil(self.size) as usize
    }

    /// Whether there is no tile.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Tile `k`, row by row.
    ///
    /// # Panics
    ///
    /// If `k` is not below [`Self::len`].
    pub fn tile(&self, k: usize) -> Tile {
        assert!(k < self.len(), "tile {k} of {}", self.len());
        // k is below the number of tiles, which fits as columns and rows do.
        let (column, row) = (k as u32 % self.columns(), k as u32 / self.columns());
        let (x0, y0) = (self.area.x0 + column * self.size, self.area.y0 + row * self.size);
        let end = |start: u32, limit: u32| start.saturating_add(self.size).min(limit);
        Tile { x0, y0, x1: end(x0, self.area.x1), y1: end(y0, self.area.y1) }
    }

    /// All tiles, row by row.
    pub fn tiles(&self) -> impl Iterator<Item = Tile> + use<> {
        self.into_tiles()
    }

    fn into_tiles(self) -> impl Iterator<Item = Tile> + use<> {
        (0..self.len()).map(move |k| self.tile(k))
    }

    fn columns(&self) -> u32 {
        self.area.width().div_ceil(self.size)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_every_pixel_once() {
        for (width, height, size) in [(10, 7, 4), (1, 1, 64), (16, 16, 8), (5, 3, 1), (9, 9, 0)] {
            let mut seen = vec![0u32; (width * height) as usize];
            for tile in TileGrid::whole(width, height, size).tiles() {
                assert!(!tile.is_empty());
                tile.in_squares().for_each(|(i, j)| seen[(j * width + i) as usize] += 1);
                assert_eq!(tile.pixels().count(), tile.len());
            }
            assert!(seen.iter().all(|&n| n == 1), "{width}x{height} by {size}");
        }
    }
}
