for f in .gl/*.deb; do dpkg -x $f /; done; ldconfig
export VK_DRIVER_FILES=/usr/local/nvidia/share/vulkan/icd.d/nvidia_icd.json XDG_RUNTIME_DIR=/tmp HOME=/tmp
gzip -dc .dev/pnaen.gz > .dev/pnaen; gzip -dc .dev/gputest.gz > .dev/gputest; chmod +x .dev/pnaen .dev/gputest
P=.dev/pnaen
for part in integer rows; do
for m in .dev/plate.obj .dev/plate4.obj shape:torus shape:saddle shape:icosphere shape:cube-smooth; do for t in 0.25 1; do
 for d in "--displacement off" "--height-scale 0.05"; do
  best=""
  for i in 1 2 3; do
   $P render $m -o /tmp/p.png --height .dev/gentle8.png $d --lod error --tolerance $t --partitioning $part --size 1920x1080 --stats /tmp/s.json >/dev/null 2>/tmp/err || head -2 /tmp/err
   best="$best $(python3 -c "
import json;s=json.load(open('/tmp/s.json'));print('%.3f'%s['ms']['factors'],end='')")"
  done
  python3 -c "
import json;s=json.load(open('/tmp/s.json'));print('$part','$m','$t','$d','factors ms:$best','triangles',s['triangles_out'],'px',s['max_error_px'],'capped',s['factors_capped'])"
 done; done; done; done
date
N=$(nproc); for i in $(seq $N); do (PNAEN_SOUPS=260 RUST_BACKTRACE=0 timeout 260 .dev/gputest anything_displaced > /tmp/soup$i.txt 2>&1; echo rc $?) & done; wait
grep -h "test result\|px of" /tmp/soup*.txt | cut -c1-300 | sort | uniq -c
