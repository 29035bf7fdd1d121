#!/usr/bin/env bash
# Compiles every SIMD source for 64-bit ARM (NEON), without linking: Debian's cross compiler and the architecture-
# independent headers of this machine are enough. Prints the compiler's messages; exits 1 if a file does not compile.
set -euo pipefail
root=$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")
compiler=aarch64-linux-gnu-g++
command -v $compiler >/dev/null || { echo "neon_compiles: please install g++-aarch64-linux-gnu" >&2; exit 1; }
headers=$(mktemp -d)
trap 'rm -rf "$headers"' EXIT
for library in hwy fmt glm embree3 oneapi tbb; do ln -s "/usr/include/$library" "$headers/$library"; done
flags=(-march=armv8-a+crypto -std=c++20 -O1 -ffp-contract=off -Wall -Wextra -I "$root" -isystem "$headers"
  '-DHWY_DISABLED_TARGETS=(HWY_SVE|HWY_SVE2|HWY_SVE_256|HWY_SVE2_128)')
cd "$root"
failed=0 count=0
for source in $(grep -rlE 'hwy/|-inl\.h' --include='*.cpp' engine systems); do
  count=$((count + 1))
  "$compiler" "${flags[@]}" -c "$source" -o /dev/null || { echo "neon_compiles: $source" >&2; failed=1; }
done
[[ $failed = 0 ]] && echo "neon_compiles: $count files"
exit $failed
