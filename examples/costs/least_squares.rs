//! Fits costs to counts by least squares.

/// Costs of `N` terms, and the largest and the mean error of the fit, in percent.
pub struct Fit<const N: usize> {
    pub costs: [f64; N],
    pub worst: f64,
    pub mean: f64,
}

/// Returns the costs, none below 0, whose sums come nearest to the counts, in relation to these.
pub fn fit<const N: usize>(frames: &[([f64; N], f64)]) -> Fit<N> {
    // Terms that no frame has cost nothing.
    let mut active: Vec<usize> = (0..N).filter(|k| frames.iter().any(|(work, _)| work[*k] > 0.0)).collect();
    let costs = loop {
        let costs = least_squares(frames, &active);
        let lowest = active.iter().copied().min_by(|a, b| costs[*a].total_cmp(&costs[*b]));
        match lowest {
            Some(k) if costs[k] < 0.0 => active.retain(|other| *other != k),
            _ => break costs,
        }
    };
    let errors = frames.iter().map(|(work, count)| (dot(work, &costs) / count - 1.0).abs());
    let (sum, worst) = errors.fold((0.0, 0.0_f64), |(sum, worst), error| (sum + error, worst.max(error)));
    Fit { costs, worst: 100.0 * worst, mean: 100.0 * sum / frames.len() as f64 }
}

/// Returns the sum of costs.
pub fn dot<const N: usize>(work: &[f64; N], costs: &[f64; N]) -> f64 {
    work.iter().zip(costs).map(|(work, cost)| work * cost).sum()
}

/// Solves the normal equations for some of the terms, by elimination.
fn least_squares<const N: usize>(frames: &[([f64; N], f64)], active: &[usize]) -> [f64; N] {
    let n = active.len();
    let mut rows = vec![vec![0.0; n + 1]; n];
    for (work, count) in frames {
        for (row, i) in rows.iter_mut().zip(active) {
            for (sum, j) in row.iter_mut().zip(active) {
                *sum += work[*i] * work[*j] / (count * count);
            }
            row[n] += work[*i] / count;
        }
    }
    for k in 0..n {
        let pivot = (k..n).max_by(|a, b| rows[*a][k].abs().total_cmp(&rows[*b][k].abs())).unwrap_or(k);
        rows.swap(k, pivot);
        let top = rows[k].clone();
        for (_, row) in rows.iter_mut().enumerate().filter(|(i, _)| *i != k) {
            let factor = row[k] / top[k];
            row.iter_mut().zip(&top).for_each(|(value, top)| *value -= factor * top);
        }
    }
    let mut costs = [0.0; N];
    for (k, term) in active.iter().enumerate() {
        costs[*term] = rows[k][n] / rows[k][k];
    }
    costs
}

/// Returns a cost in two or three digits.
pub fn number(cost: f64) -> String {
    if cost >= 20.0 { format!("{cost:.0}") } else { format!("{cost:.1}") }
}
