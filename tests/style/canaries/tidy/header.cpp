// SPDX-License-Identifier: BSD-3-Clause
// rejected by bugprone-integer-division
#include "core/header.hpp"
