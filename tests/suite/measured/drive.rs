//! A measured acceleration as the drive: the columns and units that a scene reads.

use interwell::scene::Record;

#[test]
fn a_record_is_read_by_its_names_or_by_the_units_that_end_them() {
    let expected = Record::new(vec![0.0, 0.5, 1.5], vec![9.80665, -4.903325, 0.0]);
    for text in [
        "t_s,accel_m_per_s2\n0,9.80665\n0.5,-4.903325\n1.5,0\n",
        // the two names count more than any unit
        "t_s,accel_m_per_s2,t_ms,a_g\n0,9.80665,1,1\n0.5,-4.903325,2,1\n1.5,0,3,1\n",
        "Time (ms),Stage [g]\n0,1\n500,-0.5\n1500,0\n",
        "# export\nstage, m/s^2;t_s\n9,80665;0\n-4,903325;0,5\n0;1,5\n",
        "t_us\tx_mm\ta_mg\n0\t7\t1000\n5e5\t8\t-500\n1.5e6\t9\t0\n",
    ] {
        let found = Record::parse(text).unwrap();
        assert_eq!(found.times, expected.times, "{text}");
        for (value, expected) in found.accelerations.iter().zip(&expected.accelerations) {
            assert!((value - expected).abs() < 1e-15, "{text}: {value}");
        }
    }
}

#[test]
fn what_is_no_record_is_refused_with_a_remedy() {
    for (text, words) in [
        ("t,a\n0,1\n1,2\n", &["no column t_s", "t, a", "t_s,accel_m_per_s2"][..]),
        ("t_ms,x_mm\n0,1\n1,2\n", &["no column of acceleration", "t_ms, x_mm", "end of the column's name"]),
        ("t_ms,a_g,b_g\n0,1,1\n1,2,1\n", &["a_g, b_g", "acceleration", "leave the unit to one"]),
        ("t_ms,a_g\n0,1\n5,\n", &["line 3", "a_g", "``"]),
        ("t_ms,a_g\n0,1\n5,2\n4,2\n", &["line 4", "t_ms = 4", "after 5"]),
        ("t_ms,a_g\n0,1\n", &["one row of numbers", "at least 2"]),
    ] {
        let message = Record::parse(text).unwrap_err().to_string();
        for word in words {
            assert!(message.contains(word), "`{word}` is not in: {message}");
        }
    }
    let rows: String = (0..1_000_001).map(|i| format!("{i},1\n")).collect();
    let message = Record::parse(&format!("t_ms,a_g\n{rows}")).unwrap_err().to_string();
    assert!(message.contains("more than 1000000 rows"), "{message}");
}
