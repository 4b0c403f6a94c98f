# What scripts/build_wheels builds with: a compiler for an old glibc, OpenSubdiv as a static library, headers of several
# Pythons. Sourced after setup.sh, not run. Everything lies in build/portable and is made once.

PORTABLE=${HQ_PORTABLE:-$ROOT/build/portable}  # several checkouts may share one
TOOLS=$PORTABLE/tools
# CentOS/Rocky 8's, the oldest that Blender's own builds run on.
GLIBC=2.28
OPENSUBDIV=3.5.0
# Which Debian has the headers of a Python.
declare -A DEBIAN_OF=([3.11]=bookworm [3.13]=trixie)

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

# portable_compiler: Zig as a C and C++ compiler for CMake: build/portable/toolchain.cmake.
portable_compiler() {
  local zig folder=$PORTABLE/zig name
  zig=$("$TOOLS/bin/python" -c 'import pathlib, ziglang; print(pathlib.Path(ziglang.__file__).with_name("zig"))')
  mkdir -p "$folder"
  # What ccache sees is a script that stays the same when Zig changes.
  export CCACHE_COMPILERTYPE=clang
  CCACHE_COMPILERCHECK="string:zig $("$zig" version) $GLIBC"
  export CCACHE_COMPILERCHECK
  for name in cc c++ ar ranlib; do
    local target=()
    [[ $name = c* ]] && target=(-target "x86_64-linux-gnu.$GLIBC")
    # Only where it differs, so that OpenSubdiv is compiled again where it has to be.
    local text="#!/bin/sh
exec '$zig' $name ${target[*]} \"\$@\""
    [ "$(cat "$folder/$name" 2>/dev/null)" = "$text" ] || { echo "$text" >"$folder/$name" && chmod +x "$folder/$name"; }
  done
  cat >"$PORTABLE/toolchain.cmake" <<TEXT
set(CMAKE_C_COMPILER "$folder/cc")
set(CMAKE_CXX_COMPILER "$folder/c++")
set(CMAKE_AR "$folder/ar")
set(CMAKE_RANLIB "$folder/ranlib")
TEXT
  # Debian's /usr/include also has the headers of Debian's glibc, which must not be seen.
  mkdir -p "$PORTABLE/include"
  ln -sfn /usr/include/Spectra "$PORTABLE/include/Spectra"
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

# static_opensubdiv: build/portable/opensubdiv, Debian's source of it, compiled by the portable compiler.
static_opensubdiv() {
  local folder=$PORTABLE/opensubdiv source=$PORTABLE/opensubdiv-$OPENSUBDIV
  [ -e "$folder/lib/libosdCPU.a" ] && [ "$folder/lib/libosdCPU.a" -nt "$PORTABLE/zig/c++" ] && return
  say "compiling OpenSubdiv $OPENSUBDIV as a static library"
  if [ ! -d "$source" ]; then
    (cd "$PORTABLE" && private_apt bookworm deb-src source --download-only opensubdiv)
    tar -xf "$PORTABLE/opensubdiv_$OPENSUBDIV.orig.tar.xz" -C "$PORTABLE"
  fi
  cmake -S "$source" -B "$folder" --toolchain "$PORTABLE/toolchain.cmake" -DCMAKE_BUILD_TYPE=Release \
    -DBUILD_SHARED_LIBS=OFF -DCMAKE_POSITION_INDEPENDENT_CODE=ON \
    -DNO_{EXAMPLES,TUTORIALS,REGRESSION,PTEX,DOC,OMP,TBB,CUDA,OPENCL,OPENGL,CLEW,GLFW,TESTS,GLTESTS,METAL,DX}=ON >/dev/null
  cmake --build "$folder" --target osd_static_cpu -- --quiet
}

# python_headers VERSION: build/portable/headers/VERSION, of an installed Python or else out of Debian's package.
python_headers() {
  local version=$1 folder=$PORTABLE/headers/$1 found program
  [ -e "$folder/Python.h" ] && return
  mkdir -p "$PORTABLE/headers"
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
  cp "$site"/pybind11-*.dist-info/licenses/LICENSE "$folder/pybind11.txt"
  cp "$site/ziglang/lib/libcxx/LICENSE.TXT" "$folder/libcxx.txt"
}
