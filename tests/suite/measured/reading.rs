//! The text of a measured record: layouts and units that are read, and refusals with line and remedy.

use interwell::scene::{ColumnRequest, Measured, MeasuredError, Quantity};

fn ask(quantities: &[Quantity], column: Option<&str>, unit: Option<&str>) -> ColumnRequest {
    let owned = |text: Option<&str>| text.map(str::to_owned);
    ColumnRequest::by_options(quantities, &owned(column), &owned(unit), ["--column", "--unit"])
}

fn asks() -> [ColumnRequest; 2] {
    [ask(&[Quantity::Time], None, None), ask(&[Quantity::Displacement, Quantity::Acceleration], None, None)]
}

fn read(text: &str) -> Result<Measured<2>, MeasuredError> {
    Measured::parse(text, &asks())
}

#[test]
fn layouts_and_units_that_are_meant_are_read() {
    let expected = read("t_s,x_m\n0,0.001\n0.5,0.0025\n1.5,-3e-3\n").unwrap();
    assert_eq!(expected.channels[0].values, [0.0, 0.5, 1.5]);
    assert_eq!(expected.channels[1].values, [1e-3, 2.5e-3, -3e-3]);
    for text in [
        "\u{feff}t_ms,x_mm\r\n0,1\r\n500,2.5\r\n1500,-3\r\n",
        "# recorded\nnote,Laser [mm],Time (ms)\na,1,0\n\"b, c\",2.5,500\n\n,-3,1500\n",
        "t_s;x_mm\n0;1\n0,5;2,5\n1,5;-3\n",
        "t_s\tx_um\t\n0\t1000\t\n0.5\t2500\t\n1.5\t-3000\t\n",
        "t_s,x_m,a_g\n0,0.001,9\n0.5,0.0025,8\n1.5,-3e-3,7\n",
    ] {
        let found = read(text).unwrap();
        for (channel, expected) in found.channels.iter().zip(&expected.channels) {
            assert_eq!((channel.quantity, &channel.values), (expected.quantity, &expected.values), "{text}");
        }
        assert_eq!(found.decimal_commas, text.contains("0,5;"), "{text}");
    }
    let named = [
        ask(&[Quantity::Time], Some("Zeit"), Some("ms")),
        ask(&[Quantity::Displacement], Some("Weg"), Some("mm")),
    ];
    let found = Measured::parse("Weg,Zeit\n1,0\n2.5,500\n-3,1500\n", &named).unwrap();
    assert_eq!(found.channels[1].values, expected.channels[1].values);
    let accelerations = read("t_s,a_g\n0,1\n1,2\n").unwrap();
    assert_eq!(accelerations.channels[1].quantity, Quantity::Acceleration);
    assert_eq!(accelerations.channels[1].values, [9.80665, 19.6133]);
}

#[test]
fn what_cannot_be_meant_is_refused_with_its_line_and_a_remedy() {
    for (text, words) in [
        ("", &["empty", "t_s,x_m"][..]),
        ("t_s,x_m\n", &["no row of numbers", "at least 2"]),
        ("t_s,x_m\n0,1\n", &["one row of numbers", "at least 2"]),
        ("t_s,x_m\n0,1\n1,NaN\n2,1\n", &["line 3", "x_m", "`NaN`", "left out"]),
        ("t_s,x_m\n0,1\n1,\n2,1\n", &["line 3", "x_m", "``"]),
        ("t_s,x_m\n0,1\n# pause\n2,1\n1.5,1\n", &["line 5", "t_s = 1.5", "after 2", "sort"]),
        ("t_s,x_m\n0,1\n1,1\n1,2\n", &["line 4", "t_s = 1", "after 1", "keep one"]),
        ("t_s,x_m\n0,0,1,5\n0,1,1,6\n", &["line 2", "4 values", "2 names", "semicolons"]),
        ("t_s;x_m\n0,1;1.5\n", &["line 2", "x_m", "`1.5`", "decimal point"]),
        ("0,1\n1,2\n", &["line 1", "names", "t_s,x_m"]),
        ("time,x_m\n0,1\n1,2\n", &["line 1", "no column of time", "time, x_m", "--column", "--unit"]),
        ("Sensor 5;\nt_s;x_m\n0;1\n1;2\n", &["line 1", "Sensor 5", "begin with #"]),
        ("t_s,x_m,y_mm\n0,1,2\n1,2,3\n", &["x_m, y_mm", "displacement", "--column"]),
        ("t_s,x_m\n0,\"1\n1,2\n", &["line 2", "quotation"]),
    ] {
        let message = read(text).unwrap_err().to_string();
        for word in words {
            assert!(message.contains(word), "`{word}` is not in: {message}");
        }
    }
    let unit = |column: &str, unit| {
        let asks = [ask(&[Quantity::Time], Some(column), unit)];
        Measured::parse("t_s,x\n0,1\n1,2\n", &asks).unwrap_err().to_string()
    };
    assert!(unit("x", None).contains("--unit (s, ms, us)"), "{}", unit("x", None));
    assert!(unit("x", Some("mm")).contains("`mm` is no unit of time"), "{}", unit("x", Some("mm")));
    assert!(unit("y", None).contains("no column y"), "{}", unit("y", None));
}

#[test]
fn ten_million_rows_are_the_most_that_are_read() {
    let rows = |count: usize| {
        let mut text = String::from("t_s,x_m\n");
        (0..count).for_each(|i| text += &format!("{i},1\n"));
        read(&text)
    };
    assert_eq!(rows(1_000_001).unwrap().channels[1].values.len(), 1_000_001);
    let message = rows(10_000_001).unwrap_err().to_string();
    assert!(message.contains("more than 10000000 rows"), "{message}");
}
