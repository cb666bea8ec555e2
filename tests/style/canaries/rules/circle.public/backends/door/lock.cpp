// SPDX-License-Identifier: BSD-3-Clause
#include <repel/door/lock.hpp>

#include "key.hpp"
