/// @file
/// A canary.
#pragma once
