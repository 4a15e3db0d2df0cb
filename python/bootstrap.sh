#!/usr/bin/env bash
# Makes .venv at the root of the checkout, with kinefab importable in it.
# Where the Python index answers, everything comes from there.  Where it does not and this is Debian, the
# packages come from Debian: the release's own, and trimesh (pure Python) from Debian 13.
# A stamp in .venv remembers what was installed, so a second call returns at once.
set -euo pipefail
cd "$(dirname "$0")/.."
venv=$PWD/.venv
stamp=$venv/kinefab.stamp

say() { printf 'setup: %s\n' "$*" >&2; }

if ! command -v sha256sum >/dev/null; then
    say "sha256sum is not on the PATH; it tells whether .venv is up to date.  It comes with GNU coreutils (macOS: brew install coreutils)."
    exit 1
fi
wanted=$(cat python/pyproject.toml python/bootstrap.sh | sha256sum | cut -d' ' -f1)
works() { "$venv/bin/python" -c 'import numpy, trimesh, kinefab' 2>/dev/null; }
if [ -f "$stamp" ] && [ "$(cat "$stamp")" = "$wanted" ] && works; then
    exit 0
fi
if { [ -e "$venv" ] || [ -L "$venv" ]; } && [ ! -f "$stamp" ]; then
    if works; then
        say "using .venv as it stands; it was not made here"
        exit 0
    fi
    say "$venv is there and was not made here (it has no kinefab.stamp), so it is left alone."
    say "Move it away, or install python[dev] of this checkout into it, and try again."
    exit 1
fi

# The first Python on the PATH that is new enough.
python=
for name in python3 python3.14 python3.13 python3.12 python3.11 python3.10; do
    if command -v "$name" >/dev/null && "$name" -c 'import sys; sys.exit(sys.version_info < (3, 10))' 2>/dev/null; then
        python=$(command -v "$name")
        break
    fi
done
if [ -z "$python" ]; then
    found=$(python3 -c 'import sys; print("Python %d.%d" % sys.version_info[:2])' 2>/dev/null || echo "no Python")
    say "$found is on the PATH; kinefab needs Python 3.10 or newer."
    exit 1
fi

# An empty stamp from the start, so that what a broken-off call leaves is known to be ours.
fresh() {
    rm -rf "$venv"
    "$@" "$venv" && : >"$stamp"
}

from_index() {
    fresh "$python" -m venv || return 1
    # The smallest package first: where no index answers, this fails at once.
    "$venv/bin/pip" install --quiet --disable-pip-version-check --retries 1 --timeout 15 'hatchling>=1.27' >/dev/null 2>&1 || return 1
    say "installing kinefab and its dependencies from the Python index"
    "$venv/bin/pip" install --quiet --disable-pip-version-check -e 'python[dev]'
}

as_root() {
    if [ "$(id -u)" = 0 ]; then "$@"; elif command -v sudo >/dev/null; then sudo -n "$@"; else
        say "this needs root: $*"
        return 1
    fi
}

debian_packages=(python3-venv python3-numpy python3-scipy python3-pytest python3-pytest-xdist python3-hypothesis python3-jsonschema
    python3-typer python3-rich python3-networkx python3-lxml)

from_debian() {
    command -v apt-get >/dev/null && [ -x /usr/bin/python3 ] || return 1
    local missing=() package
    for package in "${debian_packages[@]}"; do
        [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
    done
    if [ ${#missing[@]} -gt 0 ]; then
        say "installing from Debian: ${missing[*]}"
        as_root apt-get -qq update >/dev/null || true
        as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq install -y --no-install-recommends "${missing[@]}" >/dev/null || return 1
    fi
    fresh /usr/bin/python3 -m venv --system-site-packages --without-pip || return 1
    local site
    site=$("$venv/bin/python" -c 'import sysconfig; print(sysconfig.get_path("purelib"))')
    "$venv/bin/python" -c 'import trimesh' 2>/dev/null || debian_trimesh "$site" || return 1
    printf '%s\n' "$PWD/python/src" >"$site/kinefab.pth"
    printf '#!%s\nfrom kinefab.__main__ import main\nmain()\n' "$venv/bin/python" >"$venv/bin/kinefab"
    chmod +x "$venv/bin/kinefab"
}

# trimesh out of Debian 13, by the machine's own mirror and keys, without touching its package lists.
debian_trimesh() {
    local site=$1 work mirror
    mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' | grep -E '/debian/?$' | head -n 1)
    [ -n "$mirror" ] || return 1
    say "taking trimesh from Debian 13"
    work=$(mktemp -d)
    mkdir -p "$work/lists/partial" "$work/archives/partial" "$work/sources"
    printf 'Types: deb\nURIs: %s\nSuites: trixie\nComponents: main\nSigned-By: /usr/share/keyrings/debian-archive-keyring.gpg\n' \
        "$mirror" >"$work/sources/trixie.sources"
    local options=(-qq -o Dir::Etc::SourceList=/dev/null -o "Dir::Etc::SourceParts=$work/sources"
        -o "Dir::State::Lists=$work/lists" -o "Dir::Cache::Archives=$work/archives"
        -o Dir::Cache::pkgcache= -o Dir::Cache::srcpkgcache= -o APT::Sandbox::User=root)
    apt-get "${options[@]}" update >/dev/null &&
        (cd "$work" && apt-get "${options[@]}" download python3-trimesh >/dev/null) &&
        dpkg -x "$work"/python3-trimesh_*.deb "$work/files" &&
        cp -r "$work"/files/usr/lib/python3/dist-packages/trimesh* "$site/"
    local status=$?
    rm -rf "$work"
    return $status
}

if ! from_index; then
    if ! from_debian; then
        say "no Python packages to be had: neither the Python index nor Debian answered."
        say "Install python[dev] of this checkout into $venv by hand and try again."
        exit 1
    fi
fi
printf '%s' "$wanted" >"$stamp"
