#!/usr/bin/env bash
# Tries Debian packages made by scripts/package.sh: lintian on all of them, where it is installed; then geoprior on a
# bare Debian 12: installs it with what it depends on, runs the main job as a user without rights, removes it and lists
# what is left. Needs root and mmdebstrap.
#
#   scripts/try_package.sh [folder]      of the packages (default build/release/packages)
#   GEOPRIOR_MIRROR=URL                  where the system comes from (default http://deb.debian.org/debian)
set -euo pipefail
packages=$(cd "${1:-$(dirname "$0")/../build/release/packages}" && pwd)
say() { printf 'try_package: %s\n' "$*" >&2; }

if command -v lintian >/dev/null; then
  lintian --fail-on error --allow-root "$packages"/*.deb >&2
fi

command -v mmdebstrap >/dev/null || { say "apt-get install mmdebstrap: it makes the bare system"; exit 2; }
[ "$(id -u)" -eq 0 ] || { say "installing into a bare system needs root"; exit 2; }
bare=$(mktemp -d)
chmod 755 "$bare"
unmount() { umount "$bare/root/dev/shm" "$bare/root/proc" 2>/dev/null || true; }
trap 'unmount; rm -rf --one-file-system "$bare"' EXIT
mkdir "$bare/root"
say "making a bare Debian 12"
mmdebstrap --quiet --variant=apt bookworm - "${GEOPRIOR_MIRROR:-http://deb.debian.org/debian}" | tar -xC "$bare/root"
cp /etc/resolv.conf "$bare/root/etc/"
mount -t proc proc "$bare/root/proc"
mkdir -p "$bare/root/dev/shm"
mount -t tmpfs tmpfs "$bare/root/dev/shm"
cp "$packages"/geoprior_*.deb "$bare/root/tmp/"
inside() { chroot "$bare/root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8 "$@"; }
as_user() { inside setpriv --reuid=1000 --regid=1000 --clear-groups env HOME=/home/user "$@"; }
# Of what the package owns or may leave; caches of apt are the system's.
files() { (cd "$bare/root" && find etc opt root srv usr var -path var/lib/dpkg -prune -o -path '*geoprior*' -print | sort); }

say "installing geoprior with what it depends on, and nothing that it recommends"
inside apt-get -qq update
inside sh -c 'apt-get -qq install --no-install-recommends /tmp/geoprior_*.deb' >"$bare/install.log" 2>&1 ||
  { tail -n 20 "$bare/install.log" >&2; exit 1; }
mkdir -p "$bare/root/home/user"
chown 1000:1000 "$bare/root/home/user"
as_user geoprior --version
as_user geoprior doctor
as_user sh -c 'cd && geoprior run skinning/knee --quick'
(cd "$bare/root/home/user" && find . -name figure.png -o -name run.h5 -o -name report.html) >&2
[ -n "$(find "$bare/root/home/user" -name figure.png)" ] || { say "no picture was made"; exit 1; }

say "removing it"
inside apt-get -qq purge geoprior >/dev/null 2>&1
left=$(files)
[ -z "$left" ] || { say "left behind:"; printf '%s\n' "$left" >&2; exit 1; }
say "nothing is left of the package; the user's runs stay in their home folder"
