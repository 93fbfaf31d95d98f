#!/bin/sh
# Installs what pnaen needs and this machine lacks: a Vulkan loader and driver (a software one if there is no other),
# the libraries that a window uses, and for the tests a C++ compiler, a display without a screen, strace and a shader compiler. Does nothing
# where nothing is missing.
set -eu

have_library() { ldconfig -p 2>/dev/null | grep -q "$1" || find /usr/lib /usr/local/lib /lib -name "$1*" 2>/dev/null | grep -q .; }

have_vulkan_driver() {
    [ -n "${VK_DRIVER_FILES:-}${VK_ICD_FILENAMES:-}" ] ||
        find /usr/share/vulkan/icd.d /usr/local/share/vulkan/icd.d /etc/vulkan/icd.d -name '*.json' 2>/dev/null | grep -q .
}

say() { printf 'setup: %s\n' "$*" >&2; }

command -v cargo >/dev/null || {
    say "there is no Rust toolchain: install one from https://rustup.rs, then run this again"
    exit 1
}

case "$(uname -s)" in
Linux) ;;
*) exit 0 ;; # Other systems bring their own graphics and window libraries.
esac

missing=""
have_library libvulkan.so.1 || missing="$missing libvulkan1"
have_vulkan_driver || missing="$missing mesa-vulkan-drivers"
have_library libX11.so.6 || missing="$missing libx11-6"
have_library libX11-xcb.so.1 || missing="$missing libx11-xcb1"
have_library libXcursor.so.1 || missing="$missing libxcursor1"
have_library libXi.so.6 || missing="$missing libxi6"
have_library libxkbcommon.so.0 || missing="$missing libxkbcommon0"
have_library libxkbcommon-x11.so.0 || missing="$missing libxkbcommon-x11-0"
command -v cc >/dev/null || missing="$missing gcc libc6-dev"
command -v c++ >/dev/null || missing="$missing g++"
command -v Xvfb >/dev/null || missing="$missing xvfb"
command -v strace >/dev/null || missing="$missing strace"
command -v glslangValidator >/dev/null || missing="$missing glslang-tools"
[ -z "$missing" ] && exit 0

command -v apt-get >/dev/null || {
    say "these are missing, by their names in Debian:$missing; install them with this system's package manager, then run this again"
    exit 1
}
root=""
if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || {
        say "these packages are missing:$missing; run this again as root, or have them installed"
        exit 1
    }
    root="sudo"
fi
say "installing$missing"
# shellcheck disable=SC2086 # names of packages, one a word
{
    $root apt-get update -qq &&
        $root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing >/dev/null
} || {
    say "the packages could not be installed:$missing; see the messages above, or install them by hand"
    exit 1
}
