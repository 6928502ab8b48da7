//! The arguments of this call of the program, as they were read.

use clap::parser::ValueSource;
use clap::{ArgAction, ArgMatches, CommandFactory};
use interwell::output::Argument;

use super::Options;

/// The command, and its arguments in the order of `--help`.
pub fn arguments() -> (String, Vec<Argument>) {
    let program = Options::command();
    let matches = program.clone().try_get_matches_from(std::env::args_os()).ok();
    let Some((word, command)) = matches.as_ref().and_then(ArgMatches::subcommand) else {
        return (String::new(), Vec::new());
    };
    let mut all = Vec::new();
    let arguments = program.find_subcommand(word).into_iter().flat_map(|command| command.get_arguments());
    for argument in arguments.filter(|argument| argument.get_id() != "headless") {
        let id = argument.get_id().as_str();
        let is_given = |matches: &&ArgMatches| {
            matches.try_contains_id(id).is_ok() && matches.value_source(id) == Some(ValueSource::CommandLine)
        };
        // common options may also stand before the command
        let given = matches.iter().chain([command]).filter(is_given);
        let is_flag = matches!(argument.get_action(), ArgAction::SetTrue);
        for value in given.filter_map(|matches| matches.get_raw(id)).flatten() {
            let option = argument.get_long().map(str::to_owned);
            let value = (!is_flag).then(|| value.to_string_lossy().into_owned());
            all.push(Argument { option, value });
        }
    }
    (word.to_owned(), all)
}
