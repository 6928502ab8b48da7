//! Shards of a sweep on the command line: number of this process's shard, path of its rows, and commands for
//! the other shards.

use std::path::{Path, PathBuf};

use interwell::output::is_regular;
use interwell_studies::study::Shard;

use super::{Failure, refuse};

/// Placeholder for the shard in the name of a file.
pub const PLACE: &str = "{shard}";

/// The shard that `--shard` asks for: `I/N`; `auto`, with number and count from the environment of an array
/// job; `auto/N`, with only the number from there.
pub fn shard(text: &str, variable: impl Fn(&str) -> Option<String>) -> Result<Shard, Failure> {
    let wrong = |problem: String| Failure::argument(format!("--shard {text}: {problem}"));
    let Some(rest) = text.trim().strip_prefix("auto") else { return Shard::parse(text).map_err(wrong) };
    let number = |name: &str| {
        let Some(value) = variable(name) else { return Ok(None) };
        match value.trim().parse::<u64>() {
            Ok(number) => Ok(Some(number)),
            Err(_) => {
                refuse!("--shard {text}: the environment's {name} is `{value}`, which is no whole number")
            }
        }
    };
    let slurm = number("SLURM_ARRAY_TASK_ID")?;
    let Some(task) = slurm.map_or_else(|| number("HQ_TASK_ID"), |number| Ok(Some(number)))? else {
        refuse!(
            "--shard {text}: the environment has neither SLURM_ARRAY_TASK_ID nor HQ_TASK_ID, as within an \
             array job; give I/N, such as 2/5"
        );
    };
    if !rest.is_empty() {
        return Shard::parse(&format!("{task}{rest}")).map_err(wrong);
    }
    match number("SLURM_ARRAY_TASK_COUNT")?.filter(|_| slurm.is_some()) {
        Some(count) => {
            let least = number("SLURM_ARRAY_TASK_MIN")?.unwrap_or(1);
            let step = number("SLURM_ARRAY_TASK_STEP")?.unwrap_or(1).max(1);
            let number = task.checked_sub(least).map_or(0, |beyond| beyond / step + 1);
            Shard::new(number, count).map_err(wrong)
        }
        None => refuse!("--shard {text}: the environment does not say how many tasks there are; give auto/N"),
    }
}

/// The path of the rows of a shard: `out` with `{shard}` replaced, such as by `2-of-5`. With `--shard auto`
/// the placeholder is required, because all tasks of an array job have the same arguments.
pub fn placed(out: &Path, argument: Option<&str>, shard: Shard) -> Result<PathBuf, Failure> {
    let Some(argument) = argument else { return Ok(out.to_owned()) };
    let name = out.to_string_lossy();
    if name.contains(PLACE) {
        return Ok(name.replace(PLACE, &named(shard)).into());
    }
    if argument.trim().starts_with("auto") && shard.count() > 1 && is_regular(out) {
        let (out, stem) = (out.display(), out.with_extension(""));
        let example = format!("{}-{PLACE}.csv", stem.display());
        refuse!(
            "--shard {argument}: all shards would go to {out}: put {PLACE} into --out, such as {example}"
        );
    }
    Ok(out.to_owned())
}

fn named(shard: Shard) -> String {
    format!("{}-of-{}", shard.number(), shard.count())
}

/// The command with these `arguments`, and with these `options` in place of those that belong to the shard or
/// to this one call.
pub fn command(arguments: &[String], options: &[&str]) -> String {
    let mut words = vec!["interwell"];
    let mut skip_value = false;
    for argument in arguments {
        match argument.split('=').next().unwrap_or_default() {
            _ if std::mem::take(&mut skip_value) => {}
            name @ ("--shard" | "--out") => skip_value = name == argument,
            "--resume" | "--force" | "--dry-run" | "--quiet" => {}
            _ => words.push(argument),
        }
    }
    words.extend(options);
    line(words)
}

/// Quotes words for a shell and joins them.
pub fn line<'a>(words: impl IntoIterator<Item = &'a str>) -> String {
    let quoted = |word: &str| {
        let plain = |c: char| c.is_ascii_alphanumeric() || "_-+=:,./@%".contains(c);
        if !word.is_empty() && word.chars().all(plain) {
            return word.to_owned();
        }
        shlex::try_quote(word).map_or_else(|_| word.to_owned(), |quoted| quoted.into_owned())
    };
    words.into_iter().map(quoted).collect::<Vec<_>>().join(" ")
}

/// The value of `option` in `arguments`.
pub fn value<'a>(arguments: &'a [String], option: &str) -> Option<&'a str> {
    let place = arguments.iter().position(|argument| argument == option);
    let beside = place.and_then(|place| arguments.get(place + 1)).map(String::as_str);
    beside.or_else(|| arguments.iter().find_map(|argument| argument.strip_prefix(option)?.strip_prefix('=')))
}

/// The name of the file of the shard `other`, given that the file of `shard` is called `out`.
pub fn other_name(out: &str, shard: Shard, other: Shard) -> String {
    if out.contains(PLACE) {
        return out.to_owned();
    }
    if out.contains(&named(shard)) {
        return out.replace(&named(shard), &named(other));
    }
    // replace the number if it occurs exactly once, not as part of a longer number
    let (folder, name) = out.rsplit_once('/').map_or(("", out), |(folder, name)| (folder, name));
    let number = shard.number().to_string();
    let digit = |c: Option<char>| c.is_some_and(|c| c.is_ascii_digit());
    let alone = |at: &usize| {
        let (before, after) = (&name[..*at], &name[at + number.len()..]);
        !digit(before.chars().next_back()) && !digit(after.chars().next())
    };
    let places: Vec<usize> = name.match_indices(&number).map(|found| found.0).filter(alone).collect();
    let name = match places[..] {
        [at] => format!("{}{}{}", &name[..at], other.number(), &name[at + number.len()..]),
        _ => {
            let (stem, ending) = name.rsplit_once('.').unwrap_or((name, "csv"));
            format!("{stem}-{}.{ending}", named(other))
        }
    };
    if folder.is_empty() { name } else { format!("{folder}/{name}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str, variables: &[(&str, &str)]) -> Result<String, String> {
        let variable =
            |name: &str| variables.iter().find(|entry| entry.0 == name).map(|entry| entry.1.to_owned());
        shard(text, variable).map(|shard| shard.to_string()).map_err(|error| error.to_string())
    }

    #[test]
    fn an_array_job_says_which_shard_it_is() {
        let slurm = |id, count, least, step| {
            [
                ("SLURM_ARRAY_TASK_ID", id),
                ("SLURM_ARRAY_TASK_COUNT", count),
                ("SLURM_ARRAY_TASK_MIN", least),
                ("SLURM_ARRAY_TASK_STEP", step),
            ]
        };
        assert_eq!(of("auto", &slurm("3", "5", "1", "1")).unwrap(), "3/5");
        assert_eq!(of("auto", &slurm("0", "5", "0", "1")).unwrap(), "1/5");
        assert_eq!(of("auto", &slurm("17", "5", "9", "2")).unwrap(), "5/5");
        // a single task of an array is submitted again
        assert_eq!(of("auto/5", &slurm("3", "1", "3", "1")).unwrap(), "3/5");
        assert_eq!(of("auto/5", &[("HQ_TASK_ID", "2")]).unwrap(), "2/5");
        assert!(of("auto", &[("HQ_TASK_ID", "2")]).unwrap_err().contains("auto/N"));
        assert!(of("auto/5", &[("HQ_TASK_ID", "6")]).unwrap_err().contains("no shard 6 of 5"));
        assert!(of("auto", &[]).unwrap_err().contains("SLURM_ARRAY_TASK_ID"));
        assert!(of("auto", &slurm("x", "5", "1", "1")).unwrap_err().contains("`x`"));
        assert!(of("auto", &slurm("1", "5", "2", "1")).unwrap_err().contains("no shard 0 of 5"));
        assert!(of("automatic", &[("HQ_TASK_ID", "1")]).unwrap_err().contains("write I/N"));
    }

    #[test]
    fn commands_of_other_shards_can_be_copied() {
        let arguments =
            ["--headless", "sweep", "--out=a.csv", "--set", "start=At(x_mm: 1)", "--shard", "1/5"];
        let arguments: Vec<String> = arguments.iter().map(|argument| (*argument).to_owned()).collect();
        let text = command(&arguments, &["--shard", "2/5", "--out", "b.csv"]);
        let set = shlex::try_quote("start=At(x_mm: 1)").unwrap();
        assert_eq!(text, format!("interwell --headless sweep --set {set} --shard 2/5 --out b.csv"));
        let words = ["a b", "it's", "", "{shard}"];
        assert_eq!(shlex::split(&line(words)).unwrap(), words);
        assert_eq!(value(&arguments, "--out"), Some("a.csv"));
        assert_eq!(value(&arguments, "--shard"), Some("1/5"));

        let (one, three) = (Shard::new(1, 5).unwrap(), Shard::new(3, 5).unwrap());
        for (name, other) in [
            ("p1.csv", "p3.csv"),
            ("runs-1/map-1-of-5.csv", "runs-1/map-3-of-5.csv"),
            ("map-{shard}.csv", "map-{shard}.csv"),
            ("p11.csv", "p11-3-of-5.csv"),
            ("map.csv", "map-3-of-5.csv"),
        ] {
            assert_eq!(other_name(name, one, three), other);
        }
    }
}
