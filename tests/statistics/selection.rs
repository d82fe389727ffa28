//! Choosing among candidates, against all resamples there are.

use crate::close;
use skilltree::report::statistics::select;

const CANDIDATES: [[f64; 4]; 3] = [[1.0, 0.2, 0.9, 0.5], [0.7, 0.8, 0.6, 0.65], [0.1, 0.0, 0.95, 0.3]];

/// Every one of the 4^4 resamples: shares of being best, and the mean of the chosen outside the resample.
fn exhaustive() -> ([f64; 3], f64) {
    let (mut chosen, mut outside, mut counted) = ([0.0; 3], 0.0, 0.0);
    for number in 0..256_usize {
        let drawn = [number % 4, number / 4 % 4, number / 16 % 4, number / 64];
        let means = CANDIDATES.map(|values| drawn.iter().map(|&seed| values[seed]).sum::<f64>());
        let best = (0..3).max_by(|&a, &b| means[a].total_cmp(&means[b])).unwrap();
        assert!((0..3).all(|i| i == best || means[i] < means[best] - 1e-6), "no ties among these numbers");
        chosen[best] += 1.0 / 256.0;
        let left: Vec<usize> = (0..4).filter(|seed| !drawn.contains(seed)).collect();
        if !left.is_empty() {
            outside += left.iter().map(|&seed| CANDIDATES[best][seed]).sum::<f64>() / left.len() as f64;
            counted += 1.0;
        }
    }
    (chosen, outside / counted)
}

#[test]
fn shares_and_held_out_means_are_those_of_all_resamples() {
    let selection = select(&[&CANDIDATES[0], &CANDIDATES[1], &CANDIDATES[2]]).unwrap();
    assert_eq!(selection.best, 1);
    close(selection.means[0], 0.65, 1e-12);
    close(selection.means[1], 0.6875, 1e-12);
    let (chosen, outside) = exhaustive();
    for (found, exact) in selection.chosen.iter().zip(chosen) {
        // Three errors of 10,000 draws.
        close(*found, exact, 0.015);
    }
    close(selection.out_of_bag, outside, 0.015);
    // What was chosen for being high is lower on other seeds.
    assert!(selection.out_of_bag < selection.means[1] - 0.05, "{}", selection.out_of_bag);
    close(selection.behind[2].value, 0.6875 - 0.3375, 1e-12);
    assert!(selection.indistinguishable(0) && selection.indistinguishable(1));
}

/// One candidate trails by the same on every seed: no matter how the seeds differ, it is not the best.
#[test]
fn a_constant_lead_decides() {
    let best: Vec<f64> = (0..12).map(|seed| f64::from(seed) / 12.0).collect();
    let behind: Vec<f64> = best.iter().map(|value| value - 0.01).collect();
    let noisy: Vec<f64> =
        best.iter().enumerate().map(|(i, value)| value + if i % 2 == 0 { 0.1 } else { -0.12 }).collect();
    let selection = select(&[&behind, &best, &noisy]).unwrap();
    assert_eq!((selection.best, selection.undecided()), (1, 2));
    assert!(!selection.indistinguishable(0) && selection.indistinguishable(2));
    close(selection.behind[0].low, 0.01, 1e-12);
    assert_eq!(selection.chosen[0], 0.0);
}

#[test]
fn equals_share_the_first_place() {
    let selection = select(&[&[0.3, 0.9, 0.6], &[0.3, 0.9, 0.6], &[0.1, 0.1, 0.1]]).unwrap();
    close(selection.chosen[0], 0.5, 1e-9);
    close(selection.chosen[1], 0.5, 1e-9);
    assert_eq!((selection.best, selection.undecided()), (0, 2));
}

#[test]
fn candidates_that_lack_seeds_are_not_compared() {
    assert!(select(&[&[0.5, 0.6], &[0.5]]).is_none());
    assert!(select(&[]).is_none() && select(&[&[]]).is_none());
    let one = select(&[&[0.5]]).unwrap();
    assert!(one.out_of_bag.is_nan() && one.chosen == [1.0]);
}
