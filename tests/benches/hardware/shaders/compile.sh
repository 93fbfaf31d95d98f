#!/usr/bin/env bash
# Compiles every shader to a .spv beside its source, with glslangValidator (Debian: glslang-tools). `compile.sh --check`
# compares the .spv files that are here with what the sources give.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
out=$here
[ "${1:-}" != "--check" ] || out=$(mktemp -d)

make_one() {
    local source=$1 name=$2
    shift 2
    glslangValidator -V --quiet -I"$here" "$@" "$here/$source" -o "$out/$name.spv"
}

make_one patch.vert corners.vert
make_one patch.vert point.vert -DNETS_IN_MEMORY
make_one patch.tesc corners.tesc
make_one patch.tesc point.tesc -DNETS_IN_MEMORY
make_one patch.tese corners_odd.tese
make_one patch.tese corners_equal.tese -DEQUAL_SPACING
make_one patch.tese point_odd.tese -DNETS_IN_MEMORY
make_one patch.tese point_equal.tese -DNETS_IN_MEMORY -DEQUAL_SPACING
make_one surface.frag surface.frag
make_one copy.comp copy.comp

[ "$out" != "$here" ] || exit 0
for made in "$out"/*.spv; do
    cmp "$made" "$here/$(basename "$made")"
done
