/// @file
/// A canary.
#pragma once

#include <repel/bullet/arm.hpp>
