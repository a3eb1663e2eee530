#!/usr/bin/env bash
# Makes mistakes on the command line of glint, and prints each with its message and exit code.
# Usage: mistakes.sh GLINT, in an empty folder. docs/diagnostics.md has what it prints; a test compares them.
set -u
glint=$1

# A triangle without a material, and files that are in the way.
cat > scene.gltf <<'END'
{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
 "bufferViews": [{"buffer": 0, "byteLength": 36}],
 "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}
END
mkdir holiday
echo "not a package" > holiday/photos.txt

try() {
    printf '$ glint'
    printf ' %s' "$@"
    printf '\n'
    "$glint" "$@" 2>&1
    printf 'exit %s\n\n' "$?"
}

# Commands and options.
try rendr scene.gltf -o picture.png
try help rendr
try render scene.gltf -o picture.png --szie 64x64
try render -o picture.png
try render scene.gltf
try explain scene.gltf other.gltf
try render scene.gltf -o picture.png --size

# Values.
try render scene.gltf -o picture.png --size 99999x10
try render scene.gltf -o picture.png --spp 0
try render scene.gltf -o picture.png --spp 4 --spp 8
try compile scene.gltf -o package --merge famly
try compile scene.gltf -o package --strategy uber,,visibility
try compile scene.gltf -o package --fallback=maybe
try compile scene.gltf -o package -Wno-materials-range

# Options that belong together, or do not.
try compile scene.gltf -o package --lock-prune
try compile scene.gltf -o package --watch --dry-run
try render scene.gltf -o picture.png --environment-rotation 90
try render scene.gltf -o picture.png -q -v

# Files.
try render scene.gltf -o picture.jpg
try compile scene.gltf -o picture.png
try compile scene.gltf
try render missing.gltf -o picture.png
try render scene.gltf -o missing/picture.png
try compile scene.gltf -o holiday
try bench scene.gltf -o /proc/bench

# Settings that this scene can't use.
try compile scene.gltf --dry-run --passes steps --answer surface --bounces 2
try compile scene.gltf --dry-run --bounces 4 --werror
