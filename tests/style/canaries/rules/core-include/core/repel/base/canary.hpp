/// @file
/// A canary.
#pragma once

#include <yaml-cpp/yaml.h>
