//! Choice: Boltzmann exploration and the greedy child.

use super::super::random::random;
use super::{ALL, docking};
use skilltree::env::workgroup::Workgroup;
use skilltree::kernels::plain::PLAIN;
use skilltree::layout::MAX_CHILDREN;

#[test]
fn children_are_chosen_as_often_as_the_softmax_says() {
    let mut next = random(10);
    let learner = docking(&[]);
    let mut group = Workgroup::new(&learner.shared, &learner.params, &PLAIN);
    for round in 0..60 {
        let children = 1 + round % 8;
        // Any set of children but none; bits beyond the last child mean nothing.
        let drawn = (next() * 256.0) as u32;
        let all = (1 << children) - 1;
        let allowed = if drawn & all == 0 { !0 } else { drawn };
        let sharp = (next() * 30.0) as f32;
        // The children beyond the last would win if they counted.
        let q = std::array::from_fn(|i| if (i as u32) < children { (next() * 1.8 - 0.9) as f32 } else { 0.99 });
        group.q = q;
        let found = group.boltzmann(children, allowed, sharp);
        let open = |child: u32| child < children && allowed >> child & 1 == 1;
        let weight = |child: u32| {
            if open(child) { (f64::from(sharp) * f64::from(q[child as usize])).exp() } else { 0.0 }
        };
        let total: f64 = (0..8).map(weight).sum();
        let grid = 1_u32 << 16;
        let mut counts = [0_u32; MAX_CHILDREN];
        for i in 0..grid {
            counts[group.sample(found, i << 16 | 1 << 15) as usize] += 1;
        }
        for child in 0..8 {
            let share = f64::from(counts[child as usize]) / f64::from(grid);
            assert!((share - weight(child) / total).abs() < 3.0e-5, "round {round}: child {child}: {share}");
            assert!(open(child) || counts[child as usize] == 0, "round {round}: child {child} is not available");
        }
        let best = (0..children).filter(|c| open(*c)).max_by(|a, b| weight(*a).total_cmp(&weight(*b)));
        assert_eq!(Some(found.greedy), best);
        assert_eq!(found.best, q[found.greedy as usize]);
    }
    // Of equals the first; if that is not allowed, the next.
    group.q = [0.25; MAX_CHILDREN];
    assert_eq!(group.boltzmann(6, ALL, 1.0).greedy, 0);
    assert_eq!(group.boltzmann(6, ALL & !1, 1.0).greedy, 1);
    (group.q[3], group.q[5]) = (0.5, 0.5);
    assert_eq!(group.boltzmann(6, ALL, 1.0).greedy, 3);
    assert_eq!(group.boltzmann(6, ALL & !8, 1.0).greedy, 5);
    // The largest random word picks an available child too.
    let found = group.boltzmann(6, ALL, 1.0);
    assert_eq!(group.sample(found, u32::MAX), 5);
}

#[test]
fn inverse_temperature_rises_linearly_and_stays() {
    let learner = docking(&[]);
    for (trial, expected) in [(0, 20.0), (75, 70.0), (150, 120.0), (151, 120.0), (4_000_000_000, 120.0)] {
        let found = learner.seen(|group| group.inverse_temperature(0, trial));
        assert!((f64::from(found) - expected).abs() < 1.0e-4, "trial {trial}");
    }
}
