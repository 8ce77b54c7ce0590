//! gz-app as a library, for the tests package.
#![forbid(unsafe_code)]
