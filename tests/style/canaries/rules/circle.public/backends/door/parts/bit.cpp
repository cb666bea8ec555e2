// SPDX-License-Identifier: BSD-3-Clause
#include "bit.hpp"

#include <repel/door/lock.hpp>

#include "../key.hpp"
