# What scripts/build_wheels builds with: a compiler for each platform, OpenSubdiv as a static library, headers of several
# Pythons. Sourced after setup.sh, not run. Everything lies in build/portable and is made once.

PORTABLE=${HQ_PORTABLE:-$ROOT/build/portable}  # several checkouts may share one
TOOLS=$PORTABLE/tools
# CentOS/Rocky 8's, the oldest that Blender's own builds run on.
GLIBC=2.28
OPENSUBDIV=3.5.0
# Of macOS, for which Blender's own builds of 3.4 and newer are made.
OLDEST_MACOS=11.0
# Which Debian has the headers of a Python.
declare -A DEBIAN_OF=([3.11]=bookworm [3.13]=trixie [3.14]=forky)

# Elsewhere they are taken from JavaCPP's packages of CPython: their versions, and their SHA-256.
declare -A JAVACPP_OF=([3.10]=3.10.8-1.5.8 [3.11]=3.11.3-1.5.9 [3.13]=3.13.5-1.5.12)
declare -A JAVACPP_HASH=(
  [3.10.8-1.5.8-macosx-x86_64]=e48672084ecbfc071bd7ed84c4f4bad7dafcf4bde99919be4ebdf4be167b003f
  [3.10.8-1.5.8-windows-x86_64]=1e7d342425c87184fbedd8754045db556c63765678a0f11b4539465642ab018b
  [3.11.3-1.5.9-macosx-x86_64]=223aed1538351b9df68781f60afa865c5ca6cc640353cb5d46b4706049cec5e4
  [3.11.3-1.5.9-windows-x86_64]=3263a50b256447bb7b9e604d6587627e419891370fc33b94469e6a06ff4de834
  [3.13.5-1.5.12-macosx-x86_64]=0c79e881075b8d7752be384a429a8b53d14ba00d939a7d04074deb1b1d3db19c
  [3.13.5-1.5.12-windows-x86_64]=cfe5502ffa7ea369be707b6d88bf68344732a7800450665080fb4267c01bfeae
)
MAVEN=${HQ_MAVEN:-https://repo1.maven.org/maven2}

# Zig keeps the libraries that it compiles for the target.
export ZIG_GLOBAL_CACHE_DIR=$PORTABLE/zig_cache

# portable_tools: Zig, auditwheel and what builds wheels, in the versions that pyproject.toml states.
portable_tools() {
  local stamp=$TOOLS/.requirements wanted
  [ -e "$stamp" ] && [ "$stamp" -nt "$ROOT/pyproject.toml" ] && return
  say "installing Zig, auditwheel and what builds wheels into build/portable/tools"
  rm -rf "$TOOLS"
  "$PYTHON" -m venv "$TOOLS"
  mapfile -t wanted < <("$PYTHON" -c '
import sys, tomllib
project = tomllib.load(open(sys.argv[1], "rb"))
print(*project["build-system"]["requires"], *project["project"]["optional-dependencies"]["wheels"], sep="\n")' "$ROOT/pyproject.toml")
  "$TOOLS/bin/pip" install -q "${wanted[@]}"
  touch "$stamp"
}

# portable_target PLATFORM: what the functions below build for, by Blender's names: linux-x64, windows-x64, macos-arm64, macos-x64.
portable_target() {
  TARGET=$1
  PLACE=$PORTABLE/$1
  case $1 in
    linux-x64) ZIG_TARGET=x86_64-linux-gnu.$GLIBC SYSTEM='' PROCESSOR=x86_64 WHEEL_PLATFORM='' ;;
    windows-x64) ZIG_TARGET=x86_64-windows-gnu SYSTEM=Windows PROCESSOR=AMD64 WHEEL_PLATFORM=win_amd64 ;;
    macos-arm64) ZIG_TARGET=aarch64-macos.$OLDEST_MACOS SYSTEM=Darwin PROCESSOR=arm64 WHEEL_PLATFORM=macosx_${OLDEST_MACOS/./_}_arm64 ;;
    macos-x64) ZIG_TARGET=x86_64-macos.$OLDEST_MACOS SYSTEM=Darwin PROCESSOR=x86_64 WHEEL_PLATFORM=macosx_${OLDEST_MACOS/./_}_x86_64 ;;
    *) echo "no platform $1: linux-x64, windows-x64, macos-arm64 or macos-x64" >&2; return 2 ;;
  esac
  mkdir -p "$PLACE"
}

# portable_compiler: Zig as a C and C++ compiler for CMake: toolchain.cmake in the platform's folder.
portable_compiler() {
  local zig folder=$PLACE/zig name
  zig=$("$TOOLS/bin/python" -c 'import pathlib, ziglang; print(pathlib.Path(ziglang.__file__).with_name("zig"))')
  mkdir -p "$folder"
  # What ccache sees is a script that stays the same when Zig changes.
  export CCACHE_COMPILERTYPE=clang
  CCACHE_COMPILERCHECK="string:zig $("$zig" version) $ZIG_TARGET"
  export CCACHE_COMPILERCHECK
  for name in cc c++ ar ranlib rc; do
    local target=()
    [[ $name = c* ]] && target=(-target "$ZIG_TARGET")
    # Only where it differs, so that OpenSubdiv is compiled again where it has to be.
    local text="#!/bin/sh
exec '$zig' $name ${target[*]} \"\$@\""
    [ "$(cat "$folder/$name" 2>/dev/null)" = "$text" ] || { echo "$text" >"$folder/$name" && chmod +x "$folder/$name"; }
  done
  {
    if [ -n "$SYSTEM" ]; then
      echo "set(CMAKE_SYSTEM_NAME $SYSTEM)"
      echo "set(CMAKE_SYSTEM_PROCESSOR $PROCESSOR)"
      echo "set(CMAKE_RC_COMPILER \"$folder/rc\")"
      # Zig brings the system's libraries along; nothing is installed from what is built.
      echo 'set(CMAKE_OSX_SYSROOT "")'
      echo 'set(CMAKE_INSTALL_NAME_TOOL true)'
    fi
    echo "set(CMAKE_C_COMPILER \"$folder/cc\")"
    echo "set(CMAKE_CXX_COMPILER \"$folder/c++\")"
    echo "set(CMAKE_AR \"$folder/ar\")"
    echo "set(CMAKE_RANLIB \"$folder/ranlib\")"
  } >"$PLACE/toolchain.cmake"
  # Debian's /usr/include also has the headers of Debian's glibc, which must not be seen.
  mkdir -p "$PORTABLE/include"
  ln -sfn /usr/include/Spectra "$PORTABLE/include/Spectra"
  ln -sfn /usr/include/fast_float "$PORTABLE/include/fast_float"
}

# private_apt SUITE KIND WORD...: apt-get with one of Debian's suites, which the system's own apt does not get to know.
private_apt() {
  local suite=$1 kind=$2 folder=$PORTABLE/apt/$1-$2 mirror
  shift 2
  mkdir -p "$folder/lists/partial" "$folder/archives/partial"
  local apt=(apt-get -qq -o Dir::Etc::SourceList="$folder/sources.list" -o Dir::Etc::SourceParts=/dev/null
    -o Dir::State::Lists="$folder/lists" -o Dir::Cache="$folder" -o APT::Sandbox::User="$(id -un)")
  if [ ! -e "$folder/updated" ]; then
    mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' | grep -v security | head -1)
    echo "$kind [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] ${mirror:-http://deb.debian.org/debian} $suite main" \
      >"$folder/sources.list"
    "${apt[@]}" update
    touch "$folder/updated"
  fi
  "${apt[@]}" "$@"
}

# static_opensubdiv: opensubdiv in the platform's folder, Debian's source of it, compiled by the portable compiler. Blender has an
# OpenSubdiv of its own in the same process, so ours is hidden.
static_opensubdiv() {
  local folder=$PLACE/opensubdiv source=$PORTABLE/opensubdiv-$OPENSUBDIV
  [ -e "$folder/lib/libosdCPU.a" ] && [ "$folder/lib/libosdCPU.a" -nt "$PLACE/zig/c++" ] && return
  say "compiling OpenSubdiv $OPENSUBDIV as a static library for $TARGET"
  if [ ! -d "$source" ]; then
    (cd "$PORTABLE" && private_apt bookworm deb-src source --download-only opensubdiv)
    tar -xf "$PORTABLE/opensubdiv_$OPENSUBDIV.orig.tar.xz" -C "$PORTABLE"
  fi
  cmake -S "$source" -B "$folder" --toolchain "$PLACE/toolchain.cmake" -DCMAKE_BUILD_TYPE=Release \
    -DBUILD_SHARED_LIBS=OFF -DCMAKE_POSITION_INDEPENDENT_CODE=ON \
    -DCMAKE_CXX_VISIBILITY_PRESET=hidden -DCMAKE_VISIBILITY_INLINES_HIDDEN=ON \
    -DNO_{EXAMPLES,TUTORIALS,REGRESSION,PTEX,DOC,OMP,TBB,CUDA,OPENCL,OPENGL,CLEW,GLFW,TESTS,GLTESTS,METAL,DX,MACOS_FRAMEWORK}=ON >/dev/null
  cmake --build "$folder" --target osd_static_cpu -- --quiet
}

# python_headers VERSION: headers/VERSION in the platform's folder. For Linux of an installed Python or else out of Debian's package.
python_headers() {
  local version=$1 folder=$PLACE/headers/$1 found program
  [ -e "$folder/Python.h" ] && return
  mkdir -p "$PLACE/headers"
  if [ "$TARGET" != linux-x64 ]; then
    javacpp_headers "$version" "$folder"
    return
  fi
  for program in "$(command -v "python$version" || true)" "${PYENV_ROOT:-$HOME/.pyenv}/versions/$version".*/bin/python; do
    [ -x "$program" ] || continue
    # Of this version indeed: what stands in the PATH may be a wrapper.
    found=$("$program" -c 'import sys, sysconfig; print("%d.%d" % sys.version_info[:2], sysconfig.get_path("include"))' 2>/dev/null) || continue
    if [ "${found%% *}" = "$version" ] && [ -e "${found#* }/Python.h" ]; then
      say "headers of Python $version: ${found#* }"
      copy_headers "${found#* }" "/usr/include/x86_64-linux-gnu/python$version" "$folder"
      return
    fi
  done
  if [ -n "${DEBIAN_OF[$version]:-}" ]; then
    say "headers of Python $version: out of Debian's libpython$version-dev"
    local place=$PORTABLE/apt/libpython$version
    mkdir -p "$place"
    (cd "$place" && private_apt "${DEBIAN_OF[$version]}" deb download "libpython$version-dev")
    dpkg-deb -x "$place"/libpython"$version"-dev_*.deb "$place"
    copy_headers "$place/usr/include/python$version" "$place/usr/include/x86_64-linux-gnu/python$version" "$folder"
    return
  fi
  echo "no headers of Python $version: install one (for example 'pyenv install $version'), or name other versions" >&2
  return 1
}

# javacpp_headers VERSION FOLDER: for Windows, with the libraries that say what python3XX.dll has, and for macOS, where the
# headers are the same on both processors.
javacpp_headers() {
  local version=$1 folder=$2 system=macosx-x86_64 number=${JAVACPP_OF[$1]:-} name file
  [ "$TARGET" = windows-x64 ] && system=windows-x86_64
  [ -n "$number" ] || { echo "no headers of Python $version for $TARGET are known: ${!JAVACPP_OF[*]}" >&2; return 1; }
  name=$number-$system
  file=$PORTABLE/cpython-$name.jar
  say "headers of Python $version for $TARGET: out of JavaCPP's CPython $number"
  [ -e "$file" ] || curl -sSfL --retry 3 -o "$file" "$MAVEN/org/bytedeco/cpython/$number/cpython-$name.jar"
  echo "${JAVACPP_HASH[$name]}  $file" | sha256sum --check --quiet || { rm -f "$file"; return 1; }
  rm -rf "$folder.part" "$folder.jar" && mkdir -p "$folder.jar"
  "$PYTHON" -m zipfile -e "$file" "$folder.jar"
  local content=$folder.jar/org/bytedeco/cpython/$system
  if [ "$TARGET" = windows-x64 ]; then
    mv "$content/include" "$folder.part"
    mv "$content/libs" "$folder.part/libs"
  else
    mv "$content/include/python$version" "$folder.part"
  fi
  rm -rf "$folder.jar"
  mv "$folder.part" "$folder"
}

# copy_headers INCLUDE MULTIARCH FOLDER: all in one folder, as Debian's pyconfig.h includes another one by its long name.
copy_headers() {
  local include=$1 multiarch=$2 folder=$3 name
  name=$(basename "$multiarch")
  rm -rf "$folder.part"
  cp -r "$include" "$folder.part"
  if grep -q "x86_64-linux-gnu/$name/pyconfig.h" "$folder.part/pyconfig.h"; then
    mkdir -p "$folder.part/x86_64-linux-gnu"
    cp -r "$multiarch" "$folder.part/x86_64-linux-gnu/$name"
  fi
  mv "$folder.part" "$folder"
}

# collect_licences: build/portable/licences, of what is linked into the module.
collect_licences() {
  local folder=$PORTABLE/licences site
  site=$("$TOOLS/bin/python" -c 'import sysconfig; print(sysconfig.get_path("purelib"))')
  rm -rf "$folder" && mkdir -p "$folder"
  cp "$PORTABLE/opensubdiv-$OPENSUBDIV/LICENSE.txt" "$folder/OpenSubdiv.txt"
  cp "$PORTABLE/opensubdiv-$OPENSUBDIV/NOTICE.txt" "$folder/OpenSubdiv-NOTICE.txt"
  cp /usr/share/doc/libeigen3-dev/copyright "$folder/Eigen.txt"
  cp /usr/share/doc/libspectra-dev/copyright "$folder/Spectra.txt"
  cp /usr/share/doc/libfast-float-dev/copyright "$folder/fast_float.txt"
  cp "$site"/pybind11-*.dist-info/licenses/LICENSE "$folder/pybind11.txt"
  cp "$site/ziglang/lib/libcxx/LICENSE.TXT" "$folder/libcxx.txt"
}
