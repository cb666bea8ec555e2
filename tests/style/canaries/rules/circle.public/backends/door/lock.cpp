#include <repel/door/lock.hpp>

#include "key.hpp"
