/// @file
/// Closes the circle.
#pragma once
