//! The distances from the cells of a grid to the nearest marked one.

/// The squares of the distances from each cell's centre to that of the nearest marked one; infinite
/// if none is marked. After P. F. Felzenszwalb & D. P. Huttenlocher, *Theory of Computing* 8 (2012)
/// 415: along one axis, then along the other, as the lower envelope of parabolas.
pub(crate) fn squared_distances(
    marked: &[bool],
    [rows, columns]: [usize; 2],
    cell: [f64; 2],
) -> Vec<f64> {
    let mut squares: Vec<f64> = marked
        .iter()
        .map(|m| if *m { 0.0 } else { f64::INFINITY })
        .collect();
    let mut line = Vec::new();
    for row in 0..rows {
        line.clear();
        line.extend_from_slice(&squares[row * columns..][..columns]);
        for (k, square) in envelope(&line, cell[1]).into_iter().enumerate() {
            squares[row * columns + k] = square;
        }
    }
    for column in 0..columns {
        line.clear();
        line.extend((0..rows).map(|row| squares[row * columns + column]));
        for (row, square) in envelope(&line, cell[0]).into_iter().enumerate() {
            squares[row * columns + column] = square;
        }
    }
    squares
}

/// min over j of heights_j + (width (i − j))².
fn envelope(heights: &[f64], width: f64) -> Vec<f64> {
    let place = |k: usize| width * k as f64;
    let mut lowest: Vec<(usize, f64)> = Vec::new();
    for (k, height) in heights.iter().enumerate().filter(|(_, h)| h.is_finite()) {
        let mut from = f64::NEG_INFINITY;
        while let Some((last, since)) = lowest.last() {
            let (a, b) = (place(*last), place(k));
            from = if b > a {
                ((height + b * b) - (heights[*last] + a * a)) / (2.0 * (b - a))
            } else {
                f64::INFINITY
            };
            if from > *since {
                break;
            }
            lowest.pop();
            from = f64::NEG_INFINITY;
        }
        lowest.push((k, from));
    }
    let mut next = 0;
    let at = |i: usize| {
        while next + 1 < lowest.len() && lowest[next + 1].1 <= place(i) {
            next += 1;
        }
        lowest.get(next).map_or(f64::INFINITY, |(k, _)| {
            let along = place(i) - place(*k);
            heights[*k] + along * along
        })
    };
    (0..heights.len()).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::squared_distances;

    #[test]
    fn distances_are_those_to_the_nearest_marked_cell() {
        let (rows, columns, cell) = (13, 17, [0.3, 0.2]);
        let marked: Vec<bool> = (0..rows * columns).map(|k| k * k % 37 == 3).collect();
        let squares = squared_distances(&marked, [rows, columns], cell);
        let place = |k: usize| {
            [
                (k / columns) as f64 * cell[0],
                (k % columns) as f64 * cell[1],
            ]
        };
        for (k, square) in squares.iter().enumerate() {
            let [x, y] = place(k);
            let to = |j: usize| (place(j)[0] - x).powi(2) + (place(j)[1] - y).powi(2);
            let all = (0..marked.len()).filter(|j| marked[*j]).map(to);
            let nearest = all.fold(f64::INFINITY, f64::min);
            assert!((square - nearest).abs() < 1e-12, "{k}: {square} {nearest}");
        }
    }
}
