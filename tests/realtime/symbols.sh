#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# symbols.sh TICK CANARY: the object file of the tick must not lead to the heap, to a throw, to a
# lock, to output or into the kernel; the canary must be refused for each kind.
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

undefined() {
  nm -u "$1" | sed 's/.* //; s/@.*//'
}
# found KIND OBJECT: the undefined symbols of that kind.
found() {
  undefined "$2" | grep -xE "$1" | grep -vxE "$excepted" || true
}

bad=$(found "$heap|$throw|$lock|$output|$kernel" "$1")
if [ -n "$bad" ]; then
  echo "$1 is the tick and needs:"
  echo "$bad"
  exit 1
fi
# An object without the tick in it would pass too.
nm -C "$1" | grep -q 'T repel::test::one_tick' || { echo "$1 does not hold the tick"; exit 1; }
undefined "$1" | grep -qx '_ZNSt6chrono3_V212steady_clock3nowEv' ||
  { echo "$1 does not reach the budget of the coprocessor"; exit 1; }

for kind in "$heap" "$throw" "$lock" "$output" "$kernel"; do
  [ -n "$(found "$kind" "$2")" ] || { echo "the canary was not refused for $kind"; exit 1; }
done
echo "the tick needs only: $(undefined "$1" | tr '\n' ' ')"
