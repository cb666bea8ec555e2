// SPDX-License-Identifier: BSD-3-Clause
#include "../apps/teleop/options.hpp"
