/// @file
/// A canary.
#pragma once
// TODO: write it
