// SPDX-License-Identifier: BSD-3-Clause
#include "key.hpp"

#include "lock.hpp"
