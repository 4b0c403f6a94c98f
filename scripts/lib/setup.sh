# What scripts/demo and scripts/test share: system packages, Python environment, build. Sourced, not run.
# Everything here does only what is missing and says what it does.

ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
VENV=$ROOT/.venv
# Debian's Blender runs on Debian's own Python: what is built for that serves both.
PYTHON=/usr/bin/python3
ADDON=$ROOT/addon/hybrid_quad

BUILD_PACKAGES=(g++ cmake ninja-build ccache libeigen3-dev libspectra-dev libfast-float-dev libosd-dev python3 python3-venv python3-dev)
BLENDER_PACKAGES=(blender python3-numpy)
TEST_PACKAGES=(libgtest-dev python3-pytest)

export CMAKE_GENERATOR=Ninja
export CMAKE_CXX_COMPILER_LAUNCHER=ccache  # the wheel and the native tests compile the same files,
export CXX=g++                             # known as the same if the compiler goes by the same name
export PIP_DISABLE_PIP_VERSION_CHECK=1 PIP_NO_INPUT=1

say() { printf '\n== %s\n' "$*"; }

as_root() {
  if [ "$(id -u)" = 0 ]; then "$@"; else sudo "$@"; fi
}

# install_packages NAME...: Debian packages, those that are not there yet.
install_packages() {
  local missing=() name
  for name in "$@"; do
    dpkg-query -W -f='${Status}' "$name" 2>/dev/null | grep -q 'ok installed' || missing+=("$name")
  done
  [ ${#missing[@]} = 0 ] && return
  say "installing Debian packages: ${missing[*]}"
  as_root apt-get update -qq
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
}

# python_environment: .venv with what is needed to build, run and test the package.
python_environment() {
  local wanted
  "$PYTHON" -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo "Python 3.11 or newer is needed" >&2; exit 1; }
  wanted=$("$PYTHON" -c 'import sys; print("%d.%d" % sys.version_info[:2])')
  if [ "$("$VENV/bin/python" -c 'import sys; print("%d.%d" % sys.version_info[:2])' 2>/dev/null)" != "$wanted" ]; then
    say "making a Python $wanted environment in .venv"
    rm -rf "$VENV"
    "$PYTHON" -m venv "$VENV"
  fi
  local stamp=$VENV/.hybrid_quad_requirements
  if [ ! -e "$stamp" ] || [ "$ROOT/pyproject.toml" -nt "$stamp" ]; then
    say "installing Python packages into .venv: scikit-build-core pybind11 numpy meshio tqdm pytest, and for batches and tests pillow scipy distributed openjd-cli trimesh"
    "$VENV/bin/pip" install -q "scikit-build-core>=0.10" "pybind11>=2.12" "numpy>=1.24" "meshio>=5.3" "tqdm>=4.60" \
      "pytest>=7" "pytest-timeout>=2.1" "pillow>=9.4" "scipy>=1.10" "distributed>=2024.1" "openjd-cli>=0.8,<1" "trimesh>=4,<6"
    touch "$stamp"
  fi
}

# pinned_packages EXTRA: the packages of an extra in .venv, in the versions that pyproject.toml pins.
pinned_packages() {
  local wanted there tool missing=()
  wanted=$("$VENV/bin/python" -c '
import sys, tomllib
print(*tomllib.load(open(sys.argv[1], "rb"))["project"]["optional-dependencies"][sys.argv[2]])' "$ROOT/pyproject.toml" "$1")
  there=$("$VENV/bin/pip" list --format=freeze)
  for tool in $wanted; do
    grep -qxF "$tool" <<<"$there" || missing+=("$tool")
  done
  [ ${#missing[@]} = 0 ] && return
  say "installing Python packages into .venv: ${missing[*]}"
  "$VENV/bin/pip" install -q "${missing[@]}"
}

# developer_tools: ruff, mypy and clang-format in .venv.
developer_tools() { pinned_packages dev; }

# build_package: hybrid_quad in .venv, and its compiled part beside the add-on's sources, where Blender finds it.
build_package() {
  local stamp=$VENV/.hybrid_quad_built module changed
  changed=$(find "$ROOT/native" "$ROOT/addon" "$ROOT/cmake" "$ROOT/CMakeLists.txt" "$ROOT/pyproject.toml" \
    -type f ! -name '*.so' ! -name '*.pyc' -newer "$stamp" -print -quit 2>/dev/null || true)
  if [ ! -e "$stamp" ] || [ -n "$changed" ]; then
    say "building and installing hybrid_quad into .venv"
    touch "$stamp.new"
    "$VENV/bin/pip" install -q --no-build-isolation --no-deps "$ROOT"
    mv "$stamp.new" "$stamp"
  fi
  module=$(cd / && "$VENV/bin/python" -c 'import hybrid_quad.core.native as n; print(n.load().__file__)')
  if ! cmp -s "$module" "$ADDON/$(basename "$module")"; then
    say "copying $(basename "$module") to addon/hybrid_quad"
    rm -f "$ADDON"/_native*.so
    cp "$module" "$ADDON/.part" && mv "$ADDON/.part" "$ADDON/$(basename "$module")"
  fi
}
