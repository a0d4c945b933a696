//! teeter
fn main() {}
