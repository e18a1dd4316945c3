#!/usr/bin/env bash
# Make the checkout ready: `docker/setup.sh run` to serve the app, `docker/setup.sh test` also to test it.
# Debian packages that are missing are installed as root, and else named. Done twice, it does nothing.
set -euo pipefail
cd "$(dirname "$0")/.."

purpose=${1:?"usage: docker/setup.sh run|test"}
say() { printf 'gc-teach: %s\n' "$*" >&2; }
fail() { say "$*"; exit 1; }
works() { "$1" -c 'import sys; sys.exit(not (3, 11) <= sys.version_info[:2] <= (3, 14))' 2>/dev/null; }

find_python() {
    local name
    for name in ${PYTHON:-} python3.11 python3.12 python3.13 python3.14 python3; do
        if command -v "$name" >/dev/null && works "$name"; then
            command -v "$name"
            return
        fi
    done
    return 1
}

# Debian packages, by what shows that they are there.
missing_packages() {
    local python
    if python=$(find_python); then
        "$python" -c 'import ensurepip, venv' 2>/dev/null || echo "python$(version_of "$python")-venv"
    else
        echo python3 python3-venv
    fi
    if [ "$purpose" = test ]; then
        command -v chromium >/dev/null || command -v chromium-browser >/dev/null \
            || command -v google-chrome >/dev/null || echo chromium
        # The drivers of the browser and of pyright are Node programs, and Node is linked to this one.
        compgen -G '/usr/lib/*/libatomic.so.1' >/dev/null || compgen -G '/usr/lib*/libatomic.so.1' >/dev/null \
            || echo libatomic1
        # Saved skills are tested in both kinds of database.
        compgen -G '/usr/lib/postgresql/*/bin/initdb' >/dev/null || command -v initdb >/dev/null || echo postgresql
        ls /usr/share/fonts/truetype/dejavu/*.ttf >/dev/null 2>&1 || echo fonts-dejavu-core
    fi
    # Some packages are compiled where their authors offer no wheel for the machine.
    if [ "$(uname -m)" != x86_64 ] && ! command -v g++ >/dev/null; then
        echo g++ python3-dev
    fi
}

version_of() { "$1" -c 'import sys; print("%d.%d" % sys.version_info[:2])'; }

install_packages() {
    local packages
    packages=$(missing_packages | tr '\n' ' ')
    [ -n "${packages// /}" ] || return 0
    command -v apt-get >/dev/null \
        || fail "this needs what Debian calls $packages; please install it with your system's own tools."
    [ "$(id -u)" = 0 ] || fail "some Debian packages are missing; please run: sudo apt-get install $packages"
    say "installing Debian packages: $packages"
    apt-get update -q >/dev/null
    # shellcheck disable=SC2086  # a list of words
    DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends $packages >/dev/null
}

# What the environment was made from; the same again means that nothing is to do.
fingerprint() {
    { echo "$version"; pwd; cat docker/setup.sh pyproject.toml requirements*.lock; } | sha256sum
}

is_ready() {
    local done_for
    for done_for in "$purpose" test; do
        [ "$(cat ".venv/.ready-to-$done_for" 2>/dev/null)" = "$(fingerprint)" ] && return 0
    done
    return 1
}

make_environment() {
    if [ ! -x .venv/bin/python ] || [ "$(version_of .venv/bin/python)" != "$version" ]; then
        "$python" -m venv --clear .venv
    fi
    .venv/bin/python -m pip --version >/dev/null 2>&1 || .venv/bin/python -m ensurepip >/dev/null
}

install_locked() {
    local lock=requirements.lock wheels=.venv/compiled built
    [ "$purpose" = test ] && lock=requirements-dev.lock
    rm -rf "$wheels"
    # It takes as long to compile one package as to install all others.
    compile_into "$wheels" &
    built=$!
    say "installing what $lock names"
    pip_install --require-hashes --no-deps -r "$lock"
    pip_install --no-deps --no-build-isolation --editable .
    if wait "$built"; then pip_install --no-deps --no-index "$wheels"/*.whl; else say_not_compiled; fi
}

# Methods to compare with: without a compiler all else works, and they say what is missing.
compile_into() {
    can_compile || return
    say "compiling movement_primitives, to compare with"
    quiet_pip wheel --require-hashes --no-deps -r requirements-compiled.lock --wheel-dir "$1"
}

say_not_compiled() {
    say "without DMP and ProMP to compare with: movement_primitives needs a C compiler and Python's headers."
}

can_compile() {
    command -v cc >/dev/null && .venv/bin/python -c \
        'import os, sysconfig; os.stat(os.path.join(sysconfig.get_path("include"), "Python.h"))' 2>/dev/null
}

install_unlocked() {
    local extra="[study]"
    [ "$purpose" = test ] && extra="[study,dev,postgres]"
    say "this is Python $version on $(uname -m): without the lock file, and without physics (pybullet), which" \
        "needs Python 3.11 on x86_64."
    pip_install --editable ".$extra"
    { can_compile && pip_install --editable '.[compare]'; } || say_not_compiled
}

pip_install() { quiet_pip install --root-user-action ignore "$@"; }

quiet_pip() { .venv/bin/python -m pip "$1" -qq --disable-pip-version-check "${@:2}"; }

install_packages
python=$(find_python) || fail "needs Python 3.11 (or 3.12 to 3.14) and found none; please install one."
version=$(version_of "$python")
if ! is_ready; then
    make_environment
    if [ "$version" = 3.11 ] && [ "$(uname -sm)" = "Linux x86_64" ]; then install_locked; else install_unlocked; fi
    fingerprint >".venv/.ready-to-$purpose"
fi
