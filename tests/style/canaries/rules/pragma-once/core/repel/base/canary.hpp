/// @file
/// A canary.
