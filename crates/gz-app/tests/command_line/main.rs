//! The command `gz` from outside: words in; files, lines and exit codes out.

mod bad_input;
mod folder;
mod good_input;
mod query;
mod words;
