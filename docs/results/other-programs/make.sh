#!/bin/bash
# Makes the pictures beside it: each file drawn by pnaen on the left and by f3d on the right, with the same camera and light.
#
#   make.sh SCENES [FILE...]
#
# SCENES is a folder that `PNAEN_SCENES=SCENES cargo test --lib scenes_of_materials` has filled, also with the
# light; each FILE is another mesh. Prints the numbers of the page: the difference, and the means of both, where the mesh is.
# Needs pnaen, f3d, xvfb-run and ImageMagick's convert and montage.
set -euo pipefail
scenes=$1
shift
out=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for file in "$scenes"/*.glb "$@"; do
    name=$(basename "${file%.*}")
    ours=(pnaen render "$file" --surface flat --factor 1 --environment "$scenes/light.hdr" --environment-background
        --light-rotation 270 --tone-curve none --camera 0,0,2.6 --size 320x240)
    "${ours[@]}" -o "$work/ours.png"
    "${ours[@]}" --transparent -o "$work/clear.png"
    # The middle of the bounds, and the distance of the farthest vertex from it.
    pnaen tessellate "$file" --surface flat --factor 1 -o "$work/mesh.obj" 2> /dev/null
    read -r x y z radius < <(awk '
        $1 == "v" { for (i = 0; i < 3; i++) { v[n, i] = $(i + 2)
                    if (!n || v[n, i] < least[i]) least[i] = v[n, i]
                    if (!n || v[n, i] > most[i]) most[i] = v[n, i] }
                    n++ }
        END { for (i = 0; i < 3; i++) middle[i] = (least[i] + most[i]) / 2
              for (k = 0; k < n; k++) { square = 0
                    for (i = 0; i < 3; i++) square += (v[k, i] - middle[i]) ^ 2
                    if (square > largest) largest = square }
              print middle[0], middle[1], middle[2], sqrt(largest) }' "$work/mesh.obj")
    eye=$(awk -v z="$z" -v radius="$radius" 'BEGIN { print z + 2.6 * radius }')
    xvfb-run -a f3d --dry-run --output "$work/theirs.png" --resolution 320,240 --hdri "$scenes/light.hdr" \
        --camera-view-angle 40 --camera-position "$x,$y,$eye" --camera-focal-point "$x,$y,$z" --camera-view-up 0,1,0 \
        "$file" > /dev/null
    montage "$work/ours.png" "$work/theirs.png" -resize 160x120 -tile 2x1 -geometry +0+0 "$work/pair.png"
    convert "$work/clear.png" -alpha extract -threshold 0 "$work/mask.png"
    convert "$work/ours.png" "$work/theirs.png" -compose difference -composite "$work/difference.png"
    covered=$(convert "$work/mask.png" -format '%[fx:mean]' info:)
    for picture in difference ours theirs; do
        convert "$work/$picture.png" "$work/mask.png" -compose multiply -composite \
            -format '%[fx:255*mean.r] %[fx:255*mean.g] %[fx:255*mean.b]\n' info:
    done | awk -v name="$name" -v covered="$covered" '
        NR == 1 { printf "%s: %.1f;", name, ($1 + $2 + $3) / 3 / covered }
        NR > 1 { printf " %.0f, %.0f, %.0f;", $1 / covered, $2 / covered, $3 / covered }
        END { print "" }'
    convert "$work/pair.png" -strip -depth 8 -define png:exclude-chunks=date,time "$out/$name.png"
done
