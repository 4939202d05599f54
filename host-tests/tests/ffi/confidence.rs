//! Rows have confidences where the configuration asks for them, or for a least one.

use super::*;

#[test]
fn a_least_confidence_gives_rows_with_confidences() {
    let lines = lines(70, 30);
    let asked = matching::Config { min_confidence: 120, ..matching::Config::for_method::<Block>(70, 30, 32) };
    let found = c_rows::<Block>(&CConfig { min_confidence: 120, ..config(70, 30, 32) }, &lines);
    assert!(found == rows::<Block>(&asked, &lines));
    let confidences = || found.iter().flat_map(|row| row.confidences.as_deref().expect("an array"));
    assert!(confidences().all(|&sure| sure == 0 || sure >= 120));
    assert!(confidences().any(|&sure| sure > 0));
    let of_all = c_rows::<Block>(&CConfig { confidence: 1, ..config(70, 30, 32) }, &lines);
    assert!(
        of_all
            .iter()
            .flat_map(|row| row.confidences.as_deref().expect("an array"))
            .any(|&c| c < 120 && c > 0)
    );
    assert!(c_rows::<Block>(&config(70, 30, 32), &lines).iter().all(|row| row.confidences.is_none()));
}
