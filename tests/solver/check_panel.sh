#!/usr/bin/env bash
# check_panel.sh - the page that `radiosity panel` writes, in a real browser, by keyboard alone: controls change the command
# line, the parameter file goes out and comes back, and the real `solve` takes both; a phone's width, light and dark, labels,
# no error in the console, nothing asked of the network, no text of an oracle taken for markup. RADIOSITY names the command.
# Once is enough: it is about a page.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
# shellcheck source=tests/support/browser.sh
. "$top/tests/support/browser.sh"
is() { # WHAT WANTED FOUND
    count=$((count + 1))
    [ "$2" = "$3" ] || { bad=$((bad + 1)); printf 'failed: %s: wanted\n  %s\nfound\n  %s\n' "$1" "$2" "$3"; }
}
refused() { # STATUS TEXT ARGUMENT...
    count=$((count + 1))
    "$radiosity" panel "${@:3}" >out 2>err
    [ $? = "$1" ] && [ "$(wc -l <err)" = 1 ] && grep -qF -- "$2" err && [ ! -s out ] && [ ! -e x.html ] || failed "panel ${*:3}: not $2"
}

# An oracle whose texts would be markup, or end a script, if anyone let them; with every kind of control, and names that
# objects of JavaScript have.
mkdir "it's mine"
cat >"it's mine/o.dag" <<'DAG'
oracle mine "</script><script>document.title = 'x'</script> \"quoted\" & <!-- <b>bold</b> @@DATA@@ \\ 'one'" {
  param constructor : flux = 0 in [0, inf] "</script><img src=x onerror='document.title = 1'> &amp; `code`";
  param relative : ratio = 0.0537 in [0, inf] role link_threshold "\"a\" > b & c";
  param min_share : ratio = 2e-3 in [0, 1] role smallest_part "";
  param split : count = 1 in [0, 1] "yes or no";
  param rays : count = 4 in [4, 7] "few";
  param many : count = 300 in [0, 1000000000] "so many";
  param shift : ratio = 0.25 in [-1, 1] "even";
  fixed param toString : count = 16 in [4, 64] "the author's <i>own</i>";
  start level;
  node level = clusters() { surfaces -> planes; apart -> stop; receiver -> subdivide_receiver; emitter -> subdivide_emitter; }
  node planes = support_planes() { away -> stop; otherwise -> energy; }
  node energy = transfer(absolute = constructor, relative = relative * (1 + 0 * (split + shift + many))) { dark -> stop; below -> seen; above -> guard; }
  node guard = can_split(min_share = min_share) { neither -> seen; receiver -> subdivide_receiver; both | emitter -> subdivide_emitter; }
  node seen = visibility(rays = max(rays, toString)) { none -> stop; partial | all -> form; }
  node form = form_factor() { done -> link; }
}
DAG
scene=$top/examples/scenes/furnace.obj
mine="it's mine/o.dag"
# What is not written is not lost: rays and split are read by nothing that matters here, so that both releases agree.
solve() { "$radiosity" solve "$scene" --release dag -q --no-correct --no-errors "$@"; }

refused 2 "no oracle is given" -o x.html
refused 2 "the page's name is missing: -o FILE.html" bf
refused 2 "more than one oracle: ff" bf ff -o x.html
refused 2 "the oracle's name is empty" "" -o x.html
refused 2 "-o takes a file named .html, not x" bf -o x
refused 1 "nix: error: no such oracle" nix -o x.html
refused 1 "no/x.html: error" bf -o no/x.html
refused 1 "none.json" bf --statistics none.json -o x.html
check "statistics of a solve" solve --oracle "$mine" --set rays=5 --set shift=0.5 --statistics s.json
refused 1 "they are of the oracle mine, not of bf" bf --statistics s.json -o x.html
check "a page" "$radiosity" panel "$mine" --statistics s.json -o page.html
check "the same bytes again" sh -c '"$1" panel "$2" --statistics s.json -o again.html && cmp page.html again.html' - "$radiosity" "$mine"
for oracle in $("$radiosity" oracles | sed -n 's/^\([a-z_]*\)\( (default)\)*:.*/\1/p'); do
    check "a page for $oracle" "$radiosity" panel "$oracle" -o "all_$oracle.html"
done

if ! browser_command >/dev/null; then
    echo "panel: skipped: pages in a browser; install chromium"
    finish panel
    exit
fi
browser_begin || { echo "failed: the browser does not start"; tail -n 5 browser.log; exit 1; }
trap 'browser_end; rm -rf "$tmp"' EXIT
for domain in Page Runtime Log Network DOM; do ask $domain.enable; done
ask Emulation.setFocusEmulationEnabled '{"enabled": true}'
ask Browser.grantPermissions '{"permissions": ["clipboardReadWrite", "clipboardSanitizedWrite"]}'
ask Browser.setDownloadBehavior "{\"behavior\": \"allow\", \"downloadPath\": $(quote "$tmp/saved")}"
open_page() { # FILE [WIDTH]
    ask Emulation.setDeviceMetricsOverride "{\"width\": ${2:-1200}, \"height\": 800, \"deviceScaleFactor\": 1, \"mobile\": false}"
    sed -i '/Page.loadEventFired/d' events
    ask Page.navigate "{\"url\": \"file://$tmp/$1\"}"
    await Page.loadEventFired
}
shows() { # WHAT WANTED EXPRESSION
    evaluate "$3"
    is "$1" "$2" "$value"
}
at() { echo "document.getElementById('$1')"; }
focus() { evaluate "$(at "$1").focus()"; }
line() { shows "$1" "radiosity solve scene.obj --oracle 'it'\\''s mine/o.dag'$2" "$(at command).textContent"; }

open_page page.html
# ---- texts are texts
shows "the title" "mine: oracle panel" "document.title"
shows "no element from texts" 0 "document.querySelectorAll('main b, main i, img').length"
shows "the oracle's text" "</script><script>document.title = 'x'</script> \"quoted\" & <!-- <b>bold</b> @@DATA@@ \\ 'one'" "$(at doc).textContent"
shows "a parameter's text" "</script><img src=x onerror='document.title = 1'> &amp; code" "$(at p-constructor-doc).textContent"
shows "what is offered, in the oracle's order" "constructor relative min_share split rays many shift" "[...document.querySelectorAll('#offered label')].map(l => l.textContent).join(' ')"
shows "what is fixed" "toString 16" "[...document.querySelectorAll('#fixed dt, #fixed dd')].slice(0, 2).map(e => e.firstChild.textContent).join(' ')"
shows "controls that fit" "text,range+text,range+text,checkbox,select-one,range+text,range+text" \
    "[...document.querySelectorAll('#offered .control')].map(c => [...c.querySelectorAll('input, select')].map(e => e.type).join('+')).join()"
shows "each control has a name" "" "[...document.querySelectorAll('input, select, button, output')].filter(e => !(e.labels?.length || e.ariaLabel || e.textContent.trim() || e.getAttribute('aria-labelledby'))).map(e => e.outerHTML).join()"
shows "each id once" "" "[...document.querySelectorAll('[id]')].map(e => e.id).filter((id, i, all) => all.indexOf(id) !== i).join()"

shows "what was counted" "Counted in a solve of $scene with rays = 5, shift = 0.5" "$(at counted).textContent.split(':')[0]"

# ---- keyboard alone: the tab key comes to all, and to one node
stops=
for ((i = 0; i < 40; i++)); do
    press Tab 9
    evaluate "(e => e === document.body ? '' : e.id || e.ariaLabel || e.textContent)(document.activeElement)"
    [ -n "$value" ] || break # past the last
    stops="$stops$value; "
done
is "stops of the tab key" "to the parameters; smaller; fit; larger; node-level; scene; p-constructor; relative, slider; p-relative; min_share, slider; p-min_share; p-split; p-rays; many, slider; p-many; shift, slider; p-shift; Fixed by the author; command; copy; save; load; " "$stops"
line "the command before anything is changed" ""

# A slider: 20 steps are ten times as much, and 20 back are the default.
evaluate "document.querySelector('[aria-label=\"relative, slider\"]').focus()"
for ((i = 0; i < 20; i++)); do press ArrowRight 39; done
line "a slider up" " --set relative=0.54"
shows "what a slider says" "0.54" "document.activeElement.getAttribute('aria-valuetext')"
shows "the box beside it" "0.54" "$(at p-relative).value"
for ((i = 0; i < 20; i++)); do press ArrowLeft 37; done
line "a slider back" ""
press Home 36
line "a slider's low end" " --set relative=5.4e-5"
press Tab 9
type_text 1e-3
line "a number" " --set relative=0.001"
type_text inf
line "no limit" " --set relative=inf"
shows "the slider then" "inf at its end" "(e => e.ariaValueText + (e.value === e.max ? ' at its end' : ''))(document.querySelector('[aria-label=\"relative, slider\"]'))"
type_text 0,5
line "what is no number is not taken" ""
shows "and said" "'0,5' is not a number; write a point, not a comma" "$(at p-relative-wrong).textContent"
shows "and marked" true "document.activeElement.ariaInvalid"
shows "and said below" "not taken: relative" "$(at said).textContent"
type_text -1
shows "out of range" "relative takes 0 to inf" "$(at p-relative-wrong).textContent"
press Tab 9
press Enter 13 $'\r'
line "reset" ""
shows "the mark is gone" null "$(at p-relative).ariaInvalid"
shows "the box after it" 0.0537 "$(at p-relative).value"
focus p-split
press " " 32 " "
line "a box to tick" " --set split=0"
press " " 32 " "
line "and back" ""
focus p-rays
press ArrowDown 40
line "a list" " --set rays=5"
evaluate "document.querySelector('[aria-label=\"many, slider\"]').focus()"
press ArrowRight 39
line "a slider of whole numbers" " --set rays=5 --set many=340"
press Tab 9
type_text 1.5
shows "no whole number" "many takes whole numbers from 0 to 1e9" "$(at p-many-wrong).textContent"
type_text 300
line "the default, typed" " --set rays=5"
focus p-min_share
type_text 0.01
focus p-constructor
type_text 12.5
line "in the oracle's order" " --set constructor=12.5 --set min_share=0.01 --set rays=5"
focus p-shift
type_text -0.5
evaluate "$(at command).textContent"
words=$value

# ---- the command, copied, and the file, saved: the real solve takes both, to the same end
focus copy
press Enter 13 $'\r'
shows "copied" copied "new Promise(done => setTimeout(done, 50)).then(() => $(at said).textContent)"
shows "in the clipboard" "$words" "navigator.clipboard.readText()"
focus save
press " " 32 " "
for ((i = 0; i < 50; i++)); do [ -s saved/mine.params ] && break; sleep 0.1; done
is "the file" "oracle mine
constructor = 12.5
min_share = 0.01
rays = 5
shift = -0.5" "$(cat saved/mine.params)"
shows "how to use it" "saved; use it with: radiosity solve scene.obj --oracle 'it'\\''s mine/o.dag' --params mine.params" "$(at said).textContent"
runs() { # WORDS OUT: a line of the page, as a shell has it
    radiosity() { shift 2; solve "$@"; }
    eval "${1/scene.obj/scene} --faces $2"
}
check "the command runs" runs "$words" command.csv
check "the file runs" solve --oracle "$mine" --params saved/mine.params --faces file.csv
check "to the same end" cmp command.csv file.csv
solve --oracle "$mine" --faces default.csv
check "which is not that of the defaults" sh -c '! cmp -s command.csv default.csv'
evaluate "$(at reset-all).click()"
line "all reset" ""
give() { # FILE: choose it in the page
    ask Runtime.evaluate "{\"expression\": $(quote "$(at load)")}"
    object=${message#*'"objectId":"'}
    ask DOM.setFileInputFiles "{\"files\": [$(quote "$1")], \"objectId\": \"${object%%\"*}\"}"
    evaluate "new Promise(done => setTimeout(done, 50))"
}
give "$tmp/saved/mine.params"
shows "a file comes back" "$words" "$(at command).textContent"
shows "and is told" "mine.params: 4 values taken" "$(at said).textContent"
printf '# mine\n\noracle mine # here\r\nrelative=0.5\nrelative = 1\ntoString = 4\nsplit = 2\nx\n = 1\nnix = 1' >wrong.params
give "$tmp/wrong.params"
shows "a file with errors is refused whole" "$words" "$(at command).textContent"
shows "and each line told" "wrong.params is not taken.
line 5: relative is set twice, first in line 4
line 6: toString is fixed by the author, at 16
line 7: split takes whole numbers from 0 to 1
line 8: 'x' sets nothing; write NAME = VALUE
line 9: '= 1' sets nothing; write NAME = VALUE
line 10: oracle mine has no parameter nix" "$(at said).textContent"
echo "oracle bf" >other.params
give "$tmp/other.params"
shows "of another oracle" "other.params is not taken.
line 1: these are parameters of oracle bf, not of mine" "$(at said).textContent"

# ---- nodes: arrow keys go on, Enter tells, its answers lead on
focus node-level
press ArrowDown 40
press ArrowRight 39
shows "arrow keys" node-energy "document.activeElement.id"
press Enter 13 $'\r'
shows "a node's name" energy "document.querySelector('#node h3').textContent"
calls=$(tr -d '\n ' <s.json | sed 's/.*"node":"energy"[^[]*"calls":\([0-9]*\).*/\1/')
shows "a node's calls" "$calls" "[...document.querySelectorAll('#node dt')].find(e => e.textContent === 'calls').nextSibling.textContent.replace(/,/g, '')"
shows "its argument" "relative × (1 + 0 × (split + shift + many))" "[...document.querySelectorAll('#node dt')].find(e => e.textContent === 'relative').nextSibling.querySelector('code').textContent"
shows "its answers" "dark stop below seen above guard" "[...document.querySelectorAll('#node tbody tr')].map(r => r.cells[0].textContent + ' ' + r.cells[2].textContent).join(' ')"
evaluate "document.querySelectorAll('#node tbody .link')[1].focus()"
press Enter 13 $'\r'
shows "an answer leads on" guard "document.querySelector('#node h3').textContent"
shows "with the focus" node-guard "document.activeElement.id"
evaluate "[...document.querySelectorAll('#node .link')].find(e => e.textContent === 'set min_share').focus()"
press Enter 13 $'\r'
shows "a node leads to its parameter" p-min_share "document.activeElement.id"
shows "and that to its nodes" node-guard "[...document.querySelectorAll('#drawing .uses')].map(e => e.id).join()"

# ---- a phone's width, light and dark: nothing sticks out, texts stand out from what is behind (WCAG 2.1, 1.4.3: 4.5)
contrast="(() => { const rgb = c => c.match(/[\\d.]+/g).map(Number), lum = c => rgb(c).slice(0, 3).map(v => v / 255).map(v => v <= .03928 ? v / 12.92 : ((v + .055) / 1.055) ** 2.4).reduce((s, v, i) => s + v * [.2126, .7152, .0722][i], 0);
  const behind = e => { for (; e; e = e.parentElement) { const c = getComputedStyle(e).backgroundColor; if (rgb(c)[3] !== 0) return c; } return 'rgb(255,255,255)'; };
  return [...document.querySelectorAll('h1, h2, h3, p, label, td, th, dt, dd, code, output, summary, button:enabled, input:not([type=range]), select, .link')].filter(e => e.offsetParent && e.textContent + (e.value || '')).filter(e => { const a = lum(getComputedStyle(e).color), b = lum(behind(e)); return (Math.max(a, b) + .05) / (Math.min(a, b) + .05) < 4.5; }).map(e => e.tagName + ' ' + e.textContent.slice(0, 30)).join(); })()"
for page in page.html all_power.html all_tester.html all_viewfactors.html; do
    open_page $page 360
    shows "$page on a phone" true "document.documentElement.scrollWidth <= 360"
    shows "$page: no control sticks out of a phone" "" "[...document.querySelectorAll('main :is(input, select, button), #result :not(h2)')].filter(e => e.offsetParent && (e.getBoundingClientRect().right > 360 || e.getBoundingClientRect().left < 0)).map(e => e.id).join()"
    shows "$page: nothing that has the focus is hidden" "" "[...document.querySelectorAll('main :is(input, select, button:enabled)')].filter(e => { e.focus(); return e.offsetParent && e.getBoundingClientRect().bottom > $(at result).getBoundingClientRect().top + 1; }).map(e => e.id || e.ariaLabel).join()"
    for scheme in light dark; do
        ask Emulation.setEmulatedMedia "{\"features\": [{\"name\": \"prefers-color-scheme\", \"value\": \"$scheme\"}]}"
        evaluate "document.querySelector('#drawing .node').dispatchEvent(new MouseEvent('click', {bubbles: true}))"
        evaluate "getComputedStyle(document.body).backgroundColor"
        [ $scheme = light ] && light=$value
        shows "$page: contrast, $scheme" "" "$contrast"
    done
    check "$page: dark is not light" [ "$value" != "$light" ]
    is "$page: dark is another ground" different "$(evaluate "getComputedStyle(document.body).backgroundColor"; [ "$value" != "$light" ] && echo different)"
done

check "no error in the console" sh -c '! grep -e Runtime.exceptionThrown -e Log.entryAdded -e "Runtime.consoleAPICalled" events'
check "nothing is asked of the network" sh -c '! grep Network.requestWillBeSent events | grep -v "\"url\":\"file:///[^\"]*html\"" | grep -v "\"url\":\"\(blob\|data\):"'
check "pages were read" grep -q Network.requestWillBeSent events

finish panel
