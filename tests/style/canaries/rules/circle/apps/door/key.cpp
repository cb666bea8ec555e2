#include "key.hpp"

#include "lock.hpp"
