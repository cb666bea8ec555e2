/// @file
/// A canary.
#pragma once

#include <vector>
