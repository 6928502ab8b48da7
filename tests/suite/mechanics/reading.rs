//! The text of a force table: accepted layouts, and refusals with the line at fault.

use interwell::mechanics::{ForceTable, Mechanism, TableError};
use interwell::scene::ColumnsError;
use proptest::prelude::*;

#[test]
fn the_layout_of_the_text_does_not_matter() {
    let plain = "x_m,force_n\n-1,2\n0,0\n1,-2\n2,1\n";
    let expected = ForceTable::parse(plain).unwrap();
    for text in [
        "\u{feff}x_m,force_n\n-1,2\n0,0\n1,-2\n2,1\n",
        "x_m,force_n\r\n-1,2\r\n0,0\r\n1,-2\r\n2,1",
        "# a comment, with commas\n\n force_n , note, x_m \n2,a,-1\n# another\n0,,0\n-2,\"b, \
         c\",1\n\n1,d,2\n",
        "x_m,force_n\n2,1\n1,-2\n0,0\n-1,2\n",
        "x_m,force_n\n-1.0e0, +2.000\n  0 ,0\n1,-2,9,9\n2,1\n",
        "x_m,force_n\r-1,2\r\r# a comment\r0,0\r1,-2\r2,1\r",
    ] {
        assert_eq!(ForceTable::parse(text).as_ref(), Ok(&expected), "{text}");
    }
}

#[test]
fn what_is_wrong_with_a_table_is_said_with_its_line() {
    let error = |text: &str| ForceTable::parse(text).unwrap_err();
    assert!(matches!(error(""), TableError::Columns(ColumnsError::Empty { .. })));
    assert!(matches!(error("# nothing\n"), TableError::Columns(ColumnsError::Empty { .. })));
    assert_eq!(error("x_m,force_n\n0,0\n1,1\n"), TableError::TooFew(2));
    let missing = error("# c\nx_mm,force_n\n1,2\n").to_string();
    assert!(
        missing.contains("line 2") && missing.contains("x_m;") && missing.contains("x_mm, force_n"),
        "{missing}"
    );
    assert!(error("x_m;force_n\n1;2\n").to_string().contains("x_m;force_n"));
    assert_eq!(
        error("x_m,x_m,force_n\n"),
        ColumnsError::RepeatedColumn { line: 1, column: "x_m".into() }.into()
    );
    for bad in ["NaN", "inf", "-Infinity", "1e999", "one", "", "0x10", "1 2"] {
        let found = error(&format!("x_m,force_n\n0,0\n# c\n1,{bad}\n2,0\n3,0\n"));
        assert_eq!(
            found,
            ColumnsError::NoNumber { line: 4, column: "force_n".into(), value: bad.into() }.into()
        );
    }
    assert_eq!(
        error("x_m,force_n\n0,0\n1\n"),
        ColumnsError::NoNumber { line: 3, column: "force_n".into(), value: String::new() }.into()
    );
    assert_eq!(error("x_m,force_n\n0,0\n1,1\n1,2\n2,2\n"), TableError::Repeated { line: 4, x: 1.0 });
    assert_eq!(
        error("x_m,force_n\n0,0\n1,1\n2,2\n1.5,2\n"),
        TableError::TurnsBack { line: 5, x: 1.5, before: 2.0 }
    );
    assert_eq!(
        error("x_m,force_n\r0,0\r1,one\r"),
        ColumnsError::NoNumber { line: 3, column: "force_n".into(), value: "one".into() }.into()
    );
    for rest in ["c\n2,2,d\n3,3,e", "\n2,2\n3,3", "\n\",2,2\n3,3", ""] {
        let found = error(&format!("x_m,force_n,note\n-2,0,\"a, b\"\n-1,0\n0,0\n# c\n1,1,\"{rest}\n"));
        assert_eq!(found, ColumnsError::OpenQuote { line: 6 }.into());
    }
    let moves_a_cursor = error("x_m,force_n\n0,\u{1b}[2J\n").to_string();
    assert!(!moves_a_cursor.contains('\u{1b}'), "{moves_a_cursor}");
    let many = "0,0\n".repeat(100_002);
    assert_eq!(error(&format!("x_m,force_n\n{many}")), TableError::Columns(ColumnsError::TooMany(100_000)));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]
    /// No text makes the reader panic.
    #[test]
    fn any_text_is_read_or_refused(text in "(x_m|force_n|[,;\"#\n\r .0-9eE+-]){0,120}", tail in ".{0,40}") {
        let _ = Mechanism::from_table(&format!("{text}{tail}"), 1e-4);
        let _ = Mechanism::from_table(&format!("x_m,force_n\n{text}{tail}"), 1e-4);
    }
}
