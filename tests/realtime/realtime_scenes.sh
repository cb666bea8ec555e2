#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# realtime_scenes.sh PROGRAM DISTURBANCE SCENES: every tick of every scene under RealtimeSanitizer,
# whole scripts in lock step with 0 threads, a while with 2 threads and by the clock. PROGRAM is
# teleop with the sanitizer's runtime. It must end well, and for each thing that DISTURBANCE does in
# a tick not.
set -eu
program=$1 disturbance=$2 scenes=$3
here=$(dirname "$(readlink -f "$0")")
said=$(mktemp)
trap 'rm -f "$said"' EXIT

# run ARGS...: the options of the sanitizer are those for lock step where it is asked for.
run() {
  case " $* " in
    *" --fast "*) RTSAN_OPTIONS=suppressions=$here/lock_step.supp "$program" "$@" >"$said" 2>&1 ;;
    *) "$program" "$@" >"$said" 2>&1 ;;
  esac
}

passes() {
  run "$@" || { echo "teleop $*"; cat "$said"; exit 1; }
}

# refused FUNCTION ARGS...: the run is ended at a call of FUNCTION.
refused() {
  function=$1
  shift
  if run "$@"; then
    echo "the canary was not refused: $function"
    exit 1
  fi
  grep -q "unsafe function \`$function\` in real-time context" "$said" || { cat "$said"; exit 1; }
  echo "refused: $function"
}

for scene in "$scenes"/*.yaml; do
  passes "$scene" --threads 0 --fast
  passes "$scene" --threads 2 --fast --seconds 5
  passes "$scene" --threads 0 --seconds 0.3
  passes "$scene" --threads 2 --seconds 0.3
  echo "passes: $(basename "$scene")"
done

export REPEL_DISTURBANCE
for canary in "malloc allocation" "nanosleep context switch" "mmap page fault" \
  "pthread_mutex_lock lock"; do
  REPEL_DISTURBANCE=${canary#* }
  export LD_PRELOAD="$disturbance"
  refused "${canary%% *}" "$scenes/empty.yaml" --fast --seconds 0.1
  unset LD_PRELOAD
done
export REPEL_RTSAN_CANARY=worker
refused malloc "$scenes/anderson_4x8.yaml" --threads 2 --seconds 0.5
