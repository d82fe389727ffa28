//! Lists of the segments that matter in a cell change nothing: the tuned forms look at them, and so does the sonar of
//! both; what they leave out is too far away.

use super::super::random::random;
use super::{Place, light_in_sight, places, ranges};
use skilltree::backend::cpu::lanes::contact;
use skilltree::env::segments::{LISTED_TRAVEL, SegmentGrid};
use skilltree::env::workgroup::{CohortData, Workgroup};
use skilltree::kernels::plain::PLAIN;
use skilltree::math::functions::sin_cos;

/// The place's memory with cells that list all segments.
fn unculled(place: &Place) -> CohortData {
    let mut plan = place.shared.floor.plan;
    let cells = plan.cell_columns * plan.cell_rows;
    let starts = (0..=cells).map(|cell| cells + 1 + cell * plan.segments);
    let tables: Vec<u32> = starts.chain((0..cells).flat_map(|_| 0..plan.segments)).collect();
    (plan.cell_starts, plan.sight_starts) = (0, 0);
    CohortData { floor: SegmentGrid::new(&plan, &tables), tables, ..place.shared.clone() }
}

#[test]
fn culled_segment_lists_change_no_bit_of_any_sense() {
    for place in places() {
        let (culled, full) = (&place.shared, unculled(&place));
        let mut next = random(12);
        let (mut shorter, mut dark) = (0, 0);
        for _ in 0..4000 {
            let pose = place.pose(&mut next, 0.0);
            let (x, y) = (pose.x, pose.y);
            let bits = |shared: &CohortData| ranges(shared, pose).map(|found| found.map(f32::to_bits));
            let [plain, tuned] = bits(culled);
            assert_eq!([plain, plain], bits(&full), "{}: {pose:?}", place.name);
            assert_eq!(plain, tuned, "{}: {pose:?}", place.name);
            let [plain, tuned] = light_in_sight(culled, x, y);
            assert_eq!([plain, plain], light_in_sight(&full, x, y), "{}: {pose:?}", place.name);
            assert_eq!(plain, tuned, "{}: {pose:?}", place.name);
            dark += u32::from(!plain);
            shorter += u32::from(culled.floor.audible(x, y).1 < full.floor.audible(x, y).1);
        }
        assert!(shorter > 1000, "{}: the lists leave something out at {shorter} poses", place.name);
        assert!(dark > 200, "{}: the light is hidden at {dark} poses", place.name);
    }
}

#[test]
fn lists_of_what_can_be_touched_change_no_bit_of_any_move() {
    for place in places() {
        let (floor, group) = (&place.shared.floor, Workgroup::new(&place.shared, &[], &PLAIN));
        let cosine_of_docking = floor.plan.dock_cosine;
        let mut next = random(17);
        let (mut shorter, mut stops) = (0, 0);
        for _ in 0..20_000 {
            let pose = place.pose(&mut next, 0.0);
            let reach = next() as f32 * LISTED_TRAVEL;
            let (uy, ux) = sin_cos(pose.heading);
            let near = floor.touchable(pose.x, pose.y, reach);
            let [some, all] = [near, &floor.all].map(|list| {
                let travel = contact::sweep_disc(list, cosine_of_docking, pose.x, pose.y, ux, uy, reach);
                let (x, y) = (pose.x + ux * travel.distance, pose.y + uy * travel.distance);
                (travel, contact::touching_bumpers(list, x, y, ux, uy))
            });
            assert_eq!(some, all, "{}: {pose:?} for {reach}", place.name);
            let travel = group.sweep_disc(pose.x, pose.y, ux, uy, reach);
            let (x, y) = (pose.x + ux * travel.distance, pose.y + uy * travel.distance);
            assert_eq!(some, (travel, group.touching_bumpers(x, y, ux, uy)), "{}: {pose:?} for {reach}", place.name);
            shorter += u32::from(near.len() < floor.all.len());
            stops += u32::from(all.0.blocked);
        }
        assert!(stops > 1000, "{}: {stops} moves were stopped", place.name);
        assert!(place.name != "office" || shorter > 10_000, "{}: {shorter} lists leave something out", place.name);
        assert_eq!(floor.touchable(100.0, 100.0, 1.01 * LISTED_TRAVEL).len(), floor.all.len());
    }
}
