//! Scores as tables: a line for each alteration, a column for each matcher.

use stereopsis_host::real::{Alteration, Score};

/// A matcher's scores, the mean over all scenes for each of [`Alteration::ALL`].
pub struct Column {
    pub name: String,
    pub scores: Vec<Score>,
}

/// The table of one share, in percent.
pub fn of(columns: &[Column], share: fn(&Score) -> f64) -> String {
    let heads: String = columns.iter().map(|column| format!(" {} |", column.name)).collect();
    let mut table = format!("| images |{heads}\n| --- |{}\n", " ---: |".repeat(columns.len()));
    for (at, alteration) in Alteration::ALL.into_iter().enumerate() {
        let cells: String = columns
            .iter()
            .map(|column| {
                column
                    .scores
                    .get(at)
                    .map_or(" |".to_owned(), |score| format!(" {:.2} |", 100.0 * share(score)))
            })
            .collect();
        table += &format!("| {} |{cells}\n", alteration.name());
    }
    table
}

/// All of it.
pub fn page(columns: &[Column], scenes: usize, opencv: Option<&str>, parameters: &str) -> String {
    let beside = opencv.map_or(String::new(), |version| format!(" OpenCV {version}: {parameters}."));
    format!(
        "# Altered images\n\nMeans over {scenes} scenes, in percent.{beside}\n\n## Missed: wrong by over 2 \
         px or not answered\n\n{}\n## Wrong by over 2 px, of the answers\n\n{}\n## Answered\n\n{}",
        of(columns, |score| score.missed),
        of(columns, |score| score.bad2),
        of(columns, |score| score.density)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_for_each_alteration() {
        let scores =
            (0..6).map(|i| Score { density: 1.0, bad2: 0.0, missed: f64::from(i) / 100.0 }).collect();
        let table = of(&[Column { name: "`sgm`".into(), scores }], |score| score.missed);
        let expected = "| images | `sgm` |\n| --- | ---: |\n| as taken | 0.00 |\n| noise, sigma 2 | 1.00 \
                        |\n| noise, sigma 5 | 2.00 |\n| right x 1.2 + 15 | 3.00 |\n| right, gamma 0.75 | \
                        4.00 |\n| right, half a row low | 5.00 |\n";
        assert_eq!(table, expected);
    }
}
