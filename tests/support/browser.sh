# browser.sh - a browser without a window, driven over its debugging pipe: for bash scripts that source it in a folder of
# their own. Messages are JSON with a 0 behind; what is no answer is an event and goes to the file `events`.
# Source: the Chrome DevTools Protocol, version 1.3. SPDX-License-Identifier: MIT
# shellcheck shell=bash

browser_command() { command -v chromium || command -v google-chrome; }

browser_begin() {
    mkfifo to from
    "$(browser_command)" --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --no-first-run --user-data-dir="$PWD/profile" \
        --disable-background-networking --disable-component-update --remote-debugging-pipe about:blank 3<to 4>from >browser.log 2>&1 &
    browser=$!
    exec 7>to 8<from
    id=0 session=
    : >events
    ask Target.createTarget '{"url": "about:blank"}' || return 1
    local target=${message#*'"targetId":"'}
    ask Target.attachToTarget "{\"targetId\": \"${target%%\"*}\", \"flatten\": true}" || return 1
    session=${message#*'"result":{"sessionId":"'}
    session=${session%%\"*}
    [ -n "$session" ]
}

browser_end() { # its parts have ended, too, when the pipe has
    session=
    ask Browser.close && while next_message; do :; done
    exec 7>&- 8<&-
    wait "$browser" 2>/dev/null
}

# The next message, in $message; fails when none comes for ten seconds.
next_message() { IFS= read -r -d '' -t 10 message <&8; }

# METHOD [PARAMETERS]: the answer comes in $message.
ask() {
    id=$((id + 1))
    printf '{"id": %d, "method": "%s", "params": %s%s}\0' $id "$1" "${2:-{\}}" "${session:+, \"sessionId\": \"$session\"}" >&7
    while next_message; do
        case $message in
        "{\"id\":$id,"*) return 0 ;;
        *) printf '%s\n' "$message" >>events ;;
        esac
    done
    echo "the browser does not answer $1"
    return 1
}

# TEXT: wait for an event that holds it.
await() {
    grep -q -- "$1" events && return 0
    while next_message; do
        printf '%s\n' "$message" >>events
        case $message in *"$1"*) return 0 ;; esac
    done
    echo "the browser does not tell $1"
    return 1
}

quote() { # a text as a JSON string
    local text=${1//\\/\\\\}
    text=${text//\"/\\\"}
    text=${text//$'\n'/\\n}
    printf '"%s"' "$text"
}

# EXPRESSION: its value, a string, a promise of one, in $value.
evaluate() {
    ask Runtime.evaluate "{\"expression\": $(quote "(async () => String(await ($1)))()"), \"returnByValue\": true, \"awaitPromise\": true, \"userGesture\": true}"
    value=${message#*'"value":"'}
    value=${value%'"}'*}
    value=${value%'"}}'*}
    [ "$value" != "$message" ] || value="no value: $message"
    printf -v value '%b' "${value//\\\"/\"}"
}

# KEY [CODE [TEXT [MODIFIERS]]]: press and let go. CODE: the number of the key; MODIFIERS 2: Ctrl, 8: Shift.
press() {
    local rest="\"key\": $(quote "$1"), \"windowsVirtualKeyCode\": ${2:-0}, \"modifiers\": ${4:-0}"
    ask Input.dispatchKeyEvent "{\"type\": \"keyDown\", $rest${3:+, \"text\": $(quote "$3")}}"
    ask Input.dispatchKeyEvent "{\"type\": \"keyUp\", $rest}"
}

# The text, key by key, into what has the focus, in place of what is there.
type_text() {
    ask Input.dispatchKeyEvent '{"type": "keyDown", "key": "a", "windowsVirtualKeyCode": 65, "modifiers": 2, "commands": ["selectAll"]}'
    local i
    for ((i = 0; i < ${#1}; i++)); do press "${1:i:1}" 0 "${1:i:1}"; done
}
