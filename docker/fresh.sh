#!/usr/bin/env bash
# Both commands of the README in a bare Debian 12 with the last commit in it: `make run` until the first page is
# served, then `make test`. As root, with debootstrap; KEEP=1 keeps the folder, FRESH_DIR chooses where it is.
set -euo pipefail
cd "$(dirname "$0")/.."

say() { printf 'fresh: %s\n' "$*" >&2; }
fail() { say "$*"; exit 1; }
[ "$(id -u)" = 0 ] || fail "needs root, for debootstrap and chroot."
command -v debootstrap >/dev/null || fail "needs debootstrap; please run: apt-get install debootstrap"

work=$(mktemp -d "${FRESH_DIR:-${TMPDIR:-/tmp}}/gc-teach-fresh.XXXXXX")
root=$work/debian
port=18080

mounted() { grep -F " $root/" /proc/self/mounts | cut -d' ' -f2 | sort -r; }

clean_up() {
    local left
    [ -z "${server:-}" ] || kill "$server" 2>/dev/null || true
    for left in $(mounted); do umount -l "$left" || true; done
    # Never remove a tree into which something of this machine is still mounted.
    if [ -n "${KEEP:-}" ] || [ -n "$(mounted)" ] || ! rm -rf --one-file-system "$work"; then say "left in $work"; fi
}
trap clean_up EXIT

make_debian() {
    say "a bare Debian in $root"
    debootstrap --variant=minbase --include=make,ca-certificates bookworm "$root" >"$work/debootstrap.log" 2>&1 \
        || { tail -n 20 "$work/debootstrap.log" >&2; fail "debootstrap did not work."; }
    mount -t proc proc "$root/proc"
    mount --rbind /dev "$root/dev"
    mount --make-rslave "$root/dev"
}

# How this machine reaches the package registries: the same files in the same places, whatever they say.
carry_over_network() {
    local file
    local apt=()
    cp -L /etc/resolv.conf /etc/hosts "$root/etc/"
    # Another distribution's sources would make another distribution of it.
    if grep -q '^VERSION_CODENAME=bookworm' /etc/os-release && grep -q '^ID=debian' /etc/os-release; then
        rm -f "$root/etc/apt/sources.list"
        apt=(/etc/apt/sources.list /etc/apt/sources.list.d /usr/share/keyrings /etc/apt/keyrings)
    fi
    for file in "${apt[@]}" /etc/apt/apt.conf.d /etc/apt/auth.conf.d /etc/pip.conf /etc/xdg/pip \
        /root/.config/pip /root/.pip /etc/ssl/certs /usr/local/share/ca-certificates; do
        if [ -e "$file" ]; then
            mkdir -p "$root$(dirname "$file")"
            cp -aL "$file" "$root$(dirname "$file")/" 2>/dev/null || true
        fi
    done
    forget_local_packages
}

# A bare Debian has no folders with packages beside the registries; pip is not told of this machine's.
forget_local_packages() {
    find "$root/etc/pip.conf" "$root/etc/xdg/pip" "$root/root/.config/pip" "$root/root/.pip" -name '*.conf' \
        -exec sed -i -e 's|file:[^[:space:]]*||g' -e 's|^\(find-links[[:space:]]*=\).*|\1|' {} + 2>/dev/null || true
}

# Only what tells programs how to reach the network; nothing else of this machine's environment.
inside() {
    local keep
    keep=$(env | grep -iE '^((https?|ftp|all|no)_proxy|pip_[a-z_]+|ssl_cert_[a-z]+|[a-z_]*ca_bundle)=' \
        | grep -viE '^pip_find_links=|=file:' || true)
    mapfile -t keep <<<"$keep"
    [ -n "${keep[0]}" ] || keep=()
    exec chroot "$root" /usr/bin/env -i HOME=/root LANG=C.UTF-8 \
        PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
        CI="${CI:-}" "${keep[@]}" sh -c "cd /srv/gc-teach && $1"
}

page() { python3 - "$1" <<'PYTHON'
import sys, urllib.request
with urllib.request.urlopen(sys.argv[1], timeout=5) as reply:
    body = reply.read()
sys.exit(0 if reply.status == 200 and body else 1)
PYTHON
}

try_run() {
    local began=$SECONDS
    say "make run"
    (inside "exec make run ARGS='--port $port'") >"$work/run.log" 2>&1 &
    server=$!
    until page "http://127.0.0.1:$port/healthz" 2>/dev/null; do
        kill -0 "$server" 2>/dev/null || { tail -n 40 "$work/run.log" >&2; fail "make run ended by itself."; }
        [ $((SECONDS - began)) -lt 900 ] || { tail -n 40 "$work/run.log" >&2; fail "no server after 15 minutes."; }
        sleep 1
    done
    page "http://127.0.0.1:$port/" || fail "the first page was not served."
    say "make run served its first page after $((SECONDS - began)) s"
    sleep 5 # a person who stops it has looked at it first
    stop_server
}

# The process that listens, inside the chroot, is the one that SIGTERM is for.
stop_server() {
    local pid
    for pid in /proc/[0-9]*; do
        pid=${pid#/proc/}
        if [ "$(readlink "/proc/$pid/root" 2>/dev/null)" = "$root" ] \
            && tr '\0' ' ' <"/proc/$pid/cmdline" 2>/dev/null | grep -q 'gc-teach serve'; then
            kill -TERM "$pid" 2>/dev/null || true
        fi
    done
    for _ in $(seq 30); do
        kill -0 "$server" 2>/dev/null || break
        sleep 1
    done
    kill -0 "$server" 2>/dev/null && fail "it did not stop within 30 s of SIGTERM."
    wait "$server" || fail "SIGTERM ended it without saving (status $?)."
    server=
    ! page "http://127.0.0.1:$port/healthz" 2>/dev/null || fail "it still serves after SIGTERM."
}

try_test() {
    local began=$SECONDS
    say "make test"
    (inside "make test") || fail "make test failed."
    say "make test passed after $((SECONDS - began)) s"
}

make_debian
carry_over_network
mkdir -p "$root/srv/gc-teach"
git archive HEAD | tar -x -C "$root/srv/gc-teach"
try_run
try_test
say "both commands work in a bare Debian"
