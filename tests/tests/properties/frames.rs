//! P21: pictures.

use gz_app::load::Overrides;
use gz_app::threads;
use gz_bsp::BspTree;
use gz_core::{Tile, TileGrid};
use gz_shade::{Antialias, shade_frame};
use gz_tests::scenes::{color_bits, placed};
use proptest::prelude::*;
use std::sync::OnceLock;

const SIZE: (u32, u32) = (37, 23);

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn p21_threads_tiles_and_crops_cannot_be_seen(
        count in 1usize..9,
        tile in 1u32..70,
        corner in (0u32..SIZE.0, 0u32..SIZE.1),
        size in (1u32..SIZE.0, 1u32..SIZE.1),
    ) {
        static WHOLE: OnceLock<Vec<[u32; 3]>> = OnceLock::new();
        let overrides = Overrides { size: Some(SIZE), aa: Some(Antialias::None), ..Overrides::NONE };
        let (scene, needs) = placed("refraction", &overrides);
        let tree = BspTree::build(&scene.tris);
        let shade = |grid: &TileGrid| color_bits(&shade_frame(&scene, needs, &tree, grid, &|_| ()).colors);
        let whole = WHOLE.get_or_init(|| shade(&TileGrid::whole(SIZE.0, SIZE.1, 16)));
        let area = Tile { x0: corner.0, y0: corner.1, x1: (corner.0 + size.0).min(SIZE.0), y1: (corner.1 + size.1).min(SIZE.1) };
        let part = threads::with(count, || Ok(shade(&TileGrid::of(area, tile)))).expect("there are threads");
        let expected: Vec<[u32; 3]> = area.pixels().map(|(i, j)| whole[(j * SIZE.0 + i) as usize]).collect();
        prop_assert!(part == expected, "{:?}, tiles of {}, {} threads", area, tile, count);
    }
}
