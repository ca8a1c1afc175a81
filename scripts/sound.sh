# SPDX-License-Identifier: BSD-3-Clause
# Where the sound goes, and how. To be sourced, after processes.sh.

safe_period=256 safe_ring_depth=768  # frames
periods_of_card=3                    # that JACK keeps before the card plays them
through=()                           # what clients of JACK are started with

# PipeWire is the sound server of a desktop, which holds the card and can be a JACK server itself.
pipewire_runs() {
  [ -S "${PIPEWIRE_RUNTIME_DIR:-${XDG_RUNTIME_DIR:-/nowhere}}/${PIPEWIRE_REMOTE:-pipewire-0}" ]
}

# $sound is where it will go: `alsa:` and the name of $card, `pipewire`, or `dummy` without any card.
find_sound() {
  card=$(playback_card)
  if [ -z "$card" ]; then
    sound=dummy
  elif pipewire_runs && command -v pw-jack >/dev/null; then
    sound=pipewire
  else
    sound="alsa:$(cat "/proc/asound/card$card/id" 2>/dev/null || say "$card")"
  fi
}

# Starts what $sound says, with periods of so many frames. \return 1 if it does not run; $jackd is the
# server, if there is one, and $rate its rate
start_sound() { # PERIOD RATES...
  local period=$1 start
  shift
  jackd='' through=()
  for rate in "$@"; do
    case "$sound" in
      pipewire)
        through=(pw-jack -s "$rate" -p "$period")
        pipewire_plays && return
        through=()
        continue
        ;;
      dummy) start=(start_dummy_jack "$period" "$rate") ;;
      *) start=(start_jack alsa --device "hw:$card" --rate "$rate" --period "$period" --nperiods "$periods_of_card") ;;
    esac
    # A server without a desktop has nobody to ask for the card.
    [ -n "${DBUS_SESSION_BUS_ADDRESS:-}" ] || export JACK_NO_AUDIO_RESERVATION=1
    if "${start[@]}"; then
      jackd=$spawned
      return
    fi
    stop_group "$spawned"
  done
  return 1
}
pipewire_plays() { [[ $(timeout 10 "${through[@]}" jack_wait --check 2>/dev/null) == running* ]]; }

# $period, $ring_depth, $rates to try and $latency_ms (empty, if it was not measured): what
# `scripts/station --tune` found for $sound, else the safe setting.
read_sound_setting() {
  local found
  take_safe_setting
  found=$("$root/scripts/sound_setting.py" read "$sound")
  [ -n "$found" ] || return 0
  rates=()
  read -r period ring_depth "rates[0]" latency_ms <<<"$found"
}
take_safe_setting() {
  period=$safe_period ring_depth=$safe_ring_depth latency_ms=''
  rates=(44100 48000)
  [ "$sound" != pipewire ] || rates=(48000)  # that of its other programs
}

# Sound for the front door: as it was tuned, else safe, else JACK without a sound card. Says in a line
# what was done, and sets $ring_depth.
start_some_sound() {
  find_sound
  read_sound_setting
  if [ "$sound" != dummy ]; then
    if start_sound "$period" "${rates[@]}" ||
      { [ -n "$latency_ms" ] && take_safe_setting && start_sound "$period" "${rates[@]}"; }; then
      say_sound
      return
    fi
    warn "sound card hw:$card did not start; is another program using it?$(hint_of_pipewire)"
    sound=dummy
    read_sound_setting
  fi
  warn "no sound will be heard: JACK runs without a sound card"
  start_sound "$period" "${rates[@]}" ||
    { take_safe_setting && start_dummy_jack; } || die "no JACK server could be started"
}
hint_of_pipewire() {
  ! pipewire_runs || command -v pw-jack >/dev/null || printf ' PipeWire may: sudo apt install pipewire-jack'
}
say_sound() {
  local where="sound card hw:$card" how="scripts/station --tune finds how little latency this machine can keep"
  [ "$sound" != pipewire ] || where="sound through PipeWire (pw-jack), which has the sound card"
  [ -z "$latency_ms" ] || how="$latency_ms ms, as --tune found"
  say "$where; $how"
}
