//! Costs as a table: a line for each size, a column for each method on each core; and the limit that they are
//! held to.

use super::sizes::{Column, Series, Size};
use crate::steps::{Failure, Outcome};

/// The whole table. Down a part of it the work grows.
pub fn text(series: &[Series], columns: &[Column]) -> String {
    let heads: String =
        columns.iter().map(|column| format!(" {} `{}` |", column.on, column.method)).collect();
    let mut text = format!(
        "| what grows | pixels, disparities |{heads}\n| --- | --- |{}\n",
        " ---: |".repeat(columns.len())
    );
    let mut place = 0;
    for (grows, sizes) in series {
        for size in sizes {
            let costs: String = columns
                .iter()
                .map(|column| column.costs.get(place).map_or(" |".to_owned(), |cost| format!(" {cost:.2} |")))
                .collect();
            text += &format!("| {grows} | {size} |{costs}\n");
            place += 1;
        }
    }
    text
}

/// Fails where an evaluation costs over `most` times of its size what it costs at a smaller size of the same
/// series.
pub fn held(series: &[Series], columns: &[Column], most: impl Fn(Size) -> f64) -> Outcome {
    for Column { on, method, costs } in columns {
        let mut costs = costs.iter();
        for (grows, sizes) in series {
            let mut least = f64::INFINITY;
            for (size, &cost) in sizes.iter().zip(costs.by_ref()) {
                let most = most(*size);
                if cost > most * least {
                    return Err(Failure::new(format!(
                        "{method} on {on} at {size}: an evaluation costs {cost:.2}, over {most} times the \
                         {least:.2} at a smaller size; what grows is the {grows}"
                    )));
                }
                least = least.min(cost);
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::sizes;
    use super::*;
    use stereopsis_host::run::MethodName;

    fn columns(costs: &[f64]) -> Vec<Column> {
        vec![Column { on: "m4".into(), method: MethodName::Fast, costs: costs.to_vec() }]
    }

    #[test]
    fn a_cliff_is_named_and_a_fall_is_none() {
        let series = sizes::series(&[8, 16, 32], &[4, 8], &[16, 32]);
        let linear = [9.0, 8.0, 7.0, 9.0, 9.3, 8.0, 7.0];
        assert!(held(&series, &columns(&linear), |_| 1.05).is_ok());
        let told = |at: usize, cost: f64| {
            let mut costs = linear;
            costs[at] = cost;
            held(&series, &columns(&costs), |_| 1.05).expect_err("a cliff").to_string()
        };
        let expected = "fast on m4 at 32x8, 32: an evaluation costs 8.50, over 1.05 times the 8.00 at a \
                        smaller size; what grows is the width";
        assert_eq!(told(2, 8.5), expected);
        assert!(told(6, 8.5).ends_with("the 8.00 at a smaller size; what grows is the disparities"));
    }

    #[test]
    fn a_line_for_each_size() {
        let series = sizes::series(&[8, 16], &[4, 8], &[16, 32]);
        let table = text(&series, &columns(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]));
        assert_eq!(table.lines().count(), 2 + 6);
        assert!(
            table.starts_with("| what grows | pixels, disparities | m4 `fast` |\n| --- | --- | ---: |\n")
        );
        assert!(table.contains("| width | 16x8, 32 | 2.00 |\n| height | 16x4, 32 | 3.00 |\n"));
        assert!(table.ends_with("| disparities | 16x8, 32 | 6.00 |\n"));
    }
}
