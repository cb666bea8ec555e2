/// @file
/// Stands alone.
#pragma once
