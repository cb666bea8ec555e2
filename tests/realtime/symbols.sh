#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# symbols.sh TICK LIBRARY CANARY: what the object file of the tick needs of the library must not
# lead to the heap, to a throw, to a lock, to output or into the kernel; the canary must be refused
# for each kind.
set -eu
if ! command -v nm >/dev/null; then
  echo "skipped: nm is missing; to have it: apt-get install binutils"
  exit 77
fi

heap='malloc|calloc|realloc|free|aligned_alloc|posix_memalign|_Zn[wa].*|_Zd[la].*'
throw='__cxa_throw|__cxa_rethrow|__cxa_allocate_exception|_ZSt[0-9]+__throw_.*'
lock='pthread_mutex_.*|pthread_cond_.*|pthread_rwlock_.*|__cxa_guard_.*|sem_.*'
output='f?printf|f?puts|f?write|_ZSt4c(out|err)|_ZNSo.*'
kernel='syscall|futex|sched_.*|(clock_|u)?nanosleep|u?sleep|p?poll|p?select|epoll_.*|ioctl|fsync'
kernel="$kernel|(open|creat)(at)?(64)?|close|p?(read|write)v?(64)?|lseek(64)?|send.*|recv.*"
kernel="$kernel|m(map|remap|unmap|advise|protect|lock|unlock).*|s?brk|get(pid|tid|rusage|random)"
kernel="$kernel|fork|clone|exec.*|kill|raise|pthread_(create|join|kill|yield)"
# In lock step, which is for replays, threads that outnumber the processors make room for each
# other. By the clock it is not reached: tick_guard_test and every_scene_test count.
excepted='sched_yield'

tick=$1 library=$2 canary=$3 reached=$(mktemp)
trap 'rm -f "$reached"' EXIT
# The functions that lead to each other from those of the tick, each in a section of its own.
entries=$(nm "$tick" | sed -n 's/.* T /-u /p')
# shellcheck disable=SC2086
ld -r --gc-sections $entries -o "$reached" "$tick" "$library"

# The symbols that the code and data of an object refer to and do not define.
undefined() {
  { nm -u "$1" | sed 's/.* /U /; s/@.*//'; readelf -rW "$1" | awk 'NF >= 5 { print "R", $5 }'; } |
    awk '$1 == "U" { missing[$2] = 1 } $1 == "R" && missing[$2] { print $2; delete missing[$2] }'
}
# found KIND OBJECT: the undefined symbols of that kind.
found() {
  undefined "$2" | grep -xE "$1" | grep -vxE "$excepted" || true
}

bad=$(found "$heap|$throw|$lock|$output|$kernel" "$reached")
if [ -n "$bad" ]; then
  echo "$tick is the tick and needs:"
  echo "$bad"
  exit 1
fi
# An object without the tick in it would pass too.
for part in repel::test::one_tick repel::Teleoperator::run_network repel::Coprocessor::exchange; do
  nm -C "$reached" | grep -q "T $part" || { echo "$part is not in the tick"; exit 1; }
done
undefined "$reached" | grep -qx '_ZNSt6chrono3_V212steady_clock3nowEv' ||
  { echo "the tick does not reach the budget of the coprocessor"; exit 1; }

for kind in "$heap" "$throw" "$lock" "$output" "$kernel"; do
  [ -n "$(found "$kind" "$canary")" ] || { echo "the canary was not refused for $kind"; exit 1; }
done
echo "the tick needs only: $(undefined "$reached" | tr '\n' ' ')"
