#!/usr/bin/env bash
# Proves that the two commands of the README work on a Debian 12 that has git and nothing else: makes such a
# system with debootstrap in a temporary folder, clones HEAD into it, and runs `./run render` and `./run test`
# there. Nothing that happens to be installed on this machine can help, nor can ../shared.
#
#   tests/fresh_machine.sh [--as-user] [--keep] [-- render flags...]
#
# --as-user runs both as an ordinary user who has sudo instead of as root; --keep leaves the folder in place.
# Needs root (uses sudo if it is there), about 4 GB in $TMPDIR, the network, and 10 to 30 minutes.
set -euo pipefail

root=$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")
arguments=("$@")
as_user=0 keep=0 render_flags=(--spp 4 --size 64x64)
while [[ $# -gt 0 ]]; do
  case $1 in
    --as-user) as_user=1 ;;
    --keep) keep=1 ;;
    --)
      shift
      render_flags=("$@")
      break
      ;;
    *)
      sed -n '2,/^set/s/^# \{0,1\}//p' "$0"
      exit 2
      ;;
  esac
  shift
done

say() { printf 'fresh machine: %s\n' "$*"; }

# In a mount namespace of its own, whatever is mounted below vanishes with this process, however it ends.
if [[ ${METAMER_FRESH_NAMESPACE:-} != yes ]]; then
  as_root=()
  [[ $EUID == 0 ]] || as_root=(sudo)
  if ! command -v debootstrap >/dev/null; then
    say "installing debootstrap"
    "${as_root[@]}" apt-get -q -y update >/dev/null
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y install --no-install-recommends debootstrap >/dev/null
  fi
  exec "${as_root[@]}" env METAMER_FRESH_NAMESPACE=yes TMPDIR="${TMPDIR:-/tmp}" \
    unshare --mount --propagation private "${BASH_SOURCE[0]}" "${arguments[@]}"
fi

machine=$(mktemp -d "${TMPDIR:-/tmp}/metamer-fresh.XXXXXX")
chmod 755 "$machine"
cleanup() {
  umount --recursive --lazy "$machine/proc" "$machine/dev" 2>/dev/null || true
  if [[ $keep == 1 ]]; then say "left in $machine"; else rm -rf --one-file-system "$machine"; fi
}
trap cleanup EXIT
trap 'exit 130' INT TERM

seconds() { printf '%d s' $((SECONDS - began)); }

# The package source this machine uses for Debian itself: a mirror, as one-line or as deb822 source.
mirror=$(cat /etc/apt/sources.list /etc/apt/sources.list.d/debian.sources 2>/dev/null |
  sed -nE 's#^(deb |URIs:) *(\[[^]]*\] )?(https?://[^ ]+/debian)/?( .*)?$#\3#p' | head -n 1) || true
mirror=${mirror:-http://deb.debian.org/debian}

began=$SECONDS
say "a bare Debian 12 from $mirror"
extra=git,ca-certificates
[[ $as_user == 0 ]] || extra+=,sudo
if ! debootstrap --variant=minbase --include="$extra" bookworm "$machine" "$mirror" >"$machine.log" 2>&1; then
  tail -n 20 "$machine.log"
  exit 1
fi
rm -f "$machine.log"
say "made in $(seconds); it has $(chroot "$machine" dpkg-query -W | wc -l) packages, and git"

# What this machine needs to fetch packages (proxies, clocks that are off), without its package lists or hooks.
{
  apt-config dump Acquire::http Acquire::https
  apt-config dump Acquire::Check-Valid-Until Acquire::Check-Date Acquire::Retries
} 2>/dev/null | grep -E '^Acquire::[^ ]+ "[^"]+";' | sort -u >"$machine/etc/apt/apt.conf.d/90host" || true
cat >"$machine/etc/apt/sources.list" <<SOURCES
deb $mirror bookworm main
deb $mirror bookworm-updates main
SOURCES
cp -L /etc/resolv.conf "$machine/etc/resolv.conf"
mount -t proc proc "$machine/proc"
mount --rbind /dev "$machine/dev"
mount --make-rslave "$machine/dev"

home=/root
if [[ $as_user == 1 ]]; then
  chroot "$machine" useradd --create-home --shell /bin/bash visitor
  echo 'visitor ALL=(ALL) NOPASSWD: ALL' >"$machine/etc/sudoers.d/visitor"
  home=/home/visitor
fi

# Runs a command line in the bare machine, in the home folder, with a clean environment.
inside() {
  local command="cd $home && $1"
  local account=(/bin/bash -c "$command")
  [[ $as_user == 0 ]] || account=(/bin/su visitor -c "$command")
  env -i HOME=$home PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin TERM=dumb \
    ${http_proxy:+http_proxy="$http_proxy"} ${https_proxy:+https_proxy="$https_proxy"} \
    chroot "$machine" "${account[@]}" </dev/null
}

git -c safe.directory="$root" clone --quiet --bare --no-local "$root" "$machine/srv/metamer.git"
git -C "$machine/srv/metamer.git" update-ref --no-deref HEAD "$(git -c safe.directory="$root" -C "$root" rev-parse HEAD)"
chroot "$machine" chown -R "$([[ $as_user == 1 ]] && echo visitor || echo root)" /srv/metamer.git
inside "git -c advice.detachedHead=false clone --quiet /srv/metamer.git metamer"

began=$SECONDS
say "./run render ${render_flags[*]}"
inside "mkdir pictures && cd pictures && ../metamer/run render ${render_flags[*]@Q}"
inside "cd pictures && ls -l && test -n \"\$(find . -name '*.png' -size +0)\" && test -n \"\$(find . -name '*.exr' -size +0)\""
say "rendered a PNG and an EXR in $(seconds), installing and building included"

# A second time nothing is installed or built: the script has to reach the program within 2 seconds.
began=$(date +%s%N)
inside "cd pictures && ../metamer/run render --help >/dev/null"
milliseconds=$((($(date +%s%N) - began) / 1000000))
say "the second time, the program is reached in $milliseconds ms"
((milliseconds < 2000)) || exit 1

began=$SECONDS
say "./run test"
inside "cd metamer && ./run test"
say "tests passed in $(seconds), building included"

inside "cd metamer && test -z \"\$(git status --porcelain)\"" || {
  say "but the checkout is not clean any more:"
  inside "cd metamer && git status --short"
  exit 1
}
say "proven for $(git -c safe.directory="*" -C "$machine/srv/metamer.git" rev-parse --short HEAD) as $([[ $as_user == 1 ]] && echo 'a user with sudo' || echo root)"
