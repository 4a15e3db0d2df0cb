#!/bin/sh
# Builds the engines that the benchmarks compare with, outside of this repository:
#   csharp/bench/Peers/build.sh SOURCES OUT && KINEFAB_PEERS=OUT dotnet run -c Release --project csharp/bench -- peers
# SOURCES holds checkouts jitterphysics2 (notgiven688), bepuphysics2 (bepu), box3d (erincatto); ODE is the system's (libode-dev), or the
# package unpacked in SOURCES/ode. What is not there is left out. Needs the .NET SDK, cmake and a C compiler.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
sources=$(cd "$1" && pwd)
mkdir -p "$2"
out=$(cd "$2" && pwd)

if [ -d "$sources/jitterphysics2" ]; then
    dotnet build "$sources/jitterphysics2/src/Jitter2" -c Release -f net10.0 -v quiet --nologo
    cp "$sources/jitterphysics2/src/Jitter2/bin/Release/net10.0/Jitter2.dll" "$out"
fi
if [ -d "$sources/bepuphysics2" ]; then
    dotnet build "$sources/bepuphysics2/BepuPhysics" -c ReleaseNoProfiling -p:Optimize=true -v quiet --nologo
    cp "$sources"/bepuphysics2/BepuPhysics/bin/ReleaseNoProfiling/net8.0/Bepu*.dll "$out"
fi
if [ -d "$sources/box3d" ]; then
    cmake -S "$sources/box3d" -B "$sources/box3d/build" -DCMAKE_BUILD_TYPE=Release -DCMAKE_POSITION_INDEPENDENT_CODE=ON \
        -DBOX3D_SAMPLES=OFF -DBOX3D_BENCHMARKS=OFF -DBOX3D_UNIT_TESTS=OFF
    cmake --build "$sources/box3d/build" --target box3d
    cc -O3 -shared -fPIC -I "$sources/box3d/include" "$here/native/box3d.c" "$sources/box3d/build/src/libbox3d.a" -lm -lpthread -o "$out/libbox3d_peer.so"
fi
unpacked="$sources/ode/usr"
if [ -d "$unpacked" ] || [ -f /usr/include/ode/ode.h ]; then
    cc -O3 -shared -fPIC -I "$unpacked/include" "$here/native/ode.c" -L"$unpacked/lib/$(uname -m)-linux-gnu" -lode -Wl,--disable-new-dtags,-rpath,"$unpacked/lib/$(uname -m)-linux-gnu" -o "$out/libode_peer.so"
fi
ls "$out"
