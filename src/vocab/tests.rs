use super::*;

#[test]
fn words_are_found_in_any_case_and_under_every_spelling() {
    assert_eq!(find("cutter").map(|s| s.word), Some("CUTTER"));
    assert!(find("CUTTTER").is_none());
    assert_eq!(find_function("sqrtf").map(|f| f.id), Some(FunctionId::Sqrt));
}

#[test]
fn every_word_stands_once_in_the_table() {
    let mut words: Vec<&str> =
        statements().flat_map(|s| core::iter::once(s.word).chain(s.aliases.iter().copied())).collect();
    let count = words.len();
    words.sort_unstable();
    words.dedup();
    assert_eq!(words.len(), count);
}

#[test]
fn short_minor_words_stay_free_for_variables() {
    assert!(!is_reserved("V0"));
    assert!(is_reserved("DEPTH"));
    assert!(!is_reserved("CURVE"));
}

#[test]
fn only_the_last_items_of_a_lead_are_optional() {
    for form in statements().flat_map(|s| s.forms) {
        let first_optional =
            form.lead.iter().position(|i| matches!(i, Item::Optional(_))).unwrap_or(form.lead.len());
        assert!(form.lead[first_optional..].iter().all(|i| matches!(i, Item::Optional(_))), "{}", form.name);
    }
}

#[test]
fn reference_is_up_to_date() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/reference.md");
    let printed = reference::markdown();
    if std::env::var_os("UPDATE").is_some() {
        let mut file = std::fs::File::create(path).expect("docs/reference.md can be written");
        std::io::Write::write_all(&mut file, printed.as_bytes()).expect("docs/reference.md can be written");
    }
    let kept = std::fs::read_to_string(path).unwrap_or_default();
    assert!(kept == printed, "docs/reference.md is out of date: UPDATE=1 cargo test reference_is_up_to_date");
}

#[test]
fn examples_of_the_table_use_words_of_the_table() {
    for row in statements().filter(|s| !s.example.is_empty()) {
        assert!(row.example.contains(row.word), "{}", row.word);
    }
}
