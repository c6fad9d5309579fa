// SPDX-License-Identifier: Apache-2.0
// Light and dark by the reader's setting. The eight series colours are Okabe and Ito's for all kinds of colour vision,
// a little darker on white and lighter on black; markers differ too, and states are words.
#include "host/report/html_style.h"

namespace turbid {

const char* const kPageStyle = R"css(
:root { color-scheme: light dark; --paper: #fff; --ink: #1c1c1e; --muted: #5f6368; --rule: #d5d7db; --grid: #e6e8eb;
  --shade: #f5f6f7; --link: #0b57a4; --pass: #0a6b3d; --pass-shade: #e3f4ea; --fail: #a8200d; --fail-shade: #fde9e5;
  --c0: #0072b2; --c1: #d55e00; --c2: #009e73; --c3: #b3548c; --c4: #c98a00; --c5: #3a9bd9; --c6: #5b5b5b; --c7: #7a4fb5; }
@media (prefers-color-scheme: dark) { :root { --paper: #131416; --ink: #e8e8ea; --muted: #a2a7ae; --rule: #3a3d42;
  --grid: #292c30; --shade: #1d1f22; --link: #8ab8ee; --pass: #6fd6a0; --pass-shade: #10301f; --fail: #ff9a85;
  --fail-shade: #3b1712; --c0: #56a8e8; --c1: #f58a42; --c2: #35c79a; --c3: #e08fc0; --c4: #ecb731; --c5: #8fd0f7;
  --c6: #b4b4b4; --c7: #b79af0; } }
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; }
body { margin: 0 auto; padding: 1.5rem 1.25rem 4rem; max-width: 53rem; background: var(--paper); color: var(--ink);
  font: 16px/1.5 system-ui, "Segoe UI", Roboto, "Noto Sans", "Liberation Sans", sans-serif; overflow-wrap: anywhere; }
h1 { font-size: 1.75rem; line-height: 1.2; margin: 0 0 .5rem; }
h2 { font-size: 1.3rem; line-height: 1.25; margin: 2.75rem 0 .75rem; padding-bottom: .25rem;
  border-bottom: 1px solid var(--rule); }
h3 { font-size: 1rem; line-height: 1.3; margin: 0 0 .5rem; }
p { margin: .6rem 0; max-width: 46rem; white-space: pre-line; }
a { color: var(--link); }
.summary { font-size: 1.06rem; }
.verdict { margin: 1rem 0; padding: .6rem .9rem; border-left: .3rem solid; border-radius: .25rem; font-weight: 600; }
.verdict.pass { color: var(--pass); background: var(--pass-shade); }
.verdict.fail { color: var(--fail); background: var(--fail-shade); }
.verdict ul { margin: .3rem 0 0; padding-left: 1.2rem; font-weight: 400; color: var(--ink); }
nav { margin: 1rem 0; padding: .6rem .9rem; background: var(--shade); border-radius: .25rem; }
nav ol { margin: 0; padding-left: 1.4rem; columns: 16rem; }
figure { margin: 1.5rem 0 2rem; }
figcaption, caption { color: var(--muted); font-size: .9rem; line-height: 1.4; text-align: left; white-space: pre-line; }
figcaption { margin-top: .4rem; max-width: 46rem; }
.scroll { overflow-x: auto; max-width: 100%; }
table { border-collapse: collapse; font-size: .92rem; font-variant-numeric: tabular-nums; overflow-wrap: normal; }
th, td { padding: .3rem .7rem .3rem 0; text-align: left; vertical-align: baseline; }
th + th, td + td { padding-left: .7rem; }
thead th { border-top: 2px solid var(--ink); border-bottom: 1px solid var(--ink); font-weight: 600; line-height: 1.25; }
tbody tr + tr td { border-top: 1px solid var(--grid); }
tbody tr:last-child td { border-bottom: 2px solid var(--ink); }
th .unit { font-weight: 400; color: var(--muted); white-space: nowrap; }
.right { text-align: right; }
td.right { white-space: nowrap; }
thead th { vertical-align: bottom; }
td.text { min-width: 5.5rem; max-width: 26rem; }
td.long { min-width: 18rem; }
td.short { white-space: nowrap; min-width: 0; }
.state { font-weight: 600; white-space: nowrap; }
tr.pass .state { color: var(--pass); }
tr.fail .state { color: var(--fail); }
tr.fail td { background: var(--fail-shade); }
sup { font-size: .72em; line-height: 0; }
pre { margin: .4rem 0; padding: .7rem .9rem; background: var(--shade); border-radius: .25rem; overflow-x: auto;
  font: .82rem/1.45 ui-monospace, "DejaVu Sans Mono", "Liberation Mono", monospace; overflow-wrap: normal; }
.pictures { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(15rem, 100%), 1fr)); gap: 1rem; }
.pictures figure { margin: 0; min-width: 0; }
.pictures h4 { margin: 0 0 .3rem; font-size: .92rem; }
.pictures img { display: block; width: 100%; height: auto; border: 1px solid var(--rule); }
.pictures img.small { image-rendering: pixelated; }
dl { display: grid; grid-template-columns: minmax(7rem, max-content) 1fr; gap: .2rem 1rem; font-size: .92rem; margin: 0; }
dt { color: var(--muted); }
dd { margin: 0; }
svg.figure { display: block; width: 100%; height: auto; overflow: visible; font-family: inherit; }
svg.wide { max-width: 800px; }
svg.narrow { display: none; }
svg text { fill: var(--ink); }
svg .tick, svg .muted { fill: var(--muted); }
svg .raised { font-size: .75em; }
svg .axis { stroke: var(--ink); stroke-width: 1; }
svg .grid { stroke: var(--grid); stroke-width: 1; }
svg .note { fill: var(--muted); font-style: italic; }
svg .label { paint-order: stroke; stroke: var(--paper); stroke-width: 3px; stroke-linejoin: round; }
svg .series { fill: none; stroke: currentColor; stroke-width: 1.8; stroke-linejoin: round; }
svg .dashed { stroke-dasharray: 7 4; }
svg .mark { fill: currentColor; stroke: var(--paper); stroke-width: 1; }
svg .heavy.series { stroke-width: 3.2; }
svg .error { stroke: currentColor; stroke-width: 1.3; }
svg .ink { color: var(--ink); }
svg .area { fill: currentColor; }
svg .pale { fill-opacity: .35; stroke: currentColor; stroke-width: 1; }
svg .outlined:not(.pale) { stroke: var(--paper); stroke-width: .7; }
svg .slope { stroke: var(--muted); stroke-width: 1.2; stroke-dasharray: 2 3; }
svg .slope-label { fill: var(--muted); font-style: italic; }
svg .marker-line { stroke: var(--muted); stroke-width: 1.2; stroke-dasharray: 8 3 2 3; }
.c0 { color: var(--c0); } .c1 { color: var(--c1); } .c2 { color: var(--c2); } .c3 { color: var(--c3); }
.c4 { color: var(--c4); } .c5 { color: var(--c5); } .c6 { color: var(--c6); } .c7 { color: var(--c7); }
@media (min-width: 66rem) { .scroll { width: max-content; max-width: calc(50vw + 24rem); } }
@media (max-width: 36rem) {
  body { padding: 1rem .75rem 3rem; }
  h1 { font-size: 1.4rem; }
  h2 { font-size: 1.18rem; margin-top: 2.2rem; }
  svg.wide { display: none; }
  svg.narrow { display: block; max-width: 480px; }
  dl { grid-template-columns: 1fr; gap: 0; }
  dd { margin-bottom: .4rem; }
}
@media print { body { max-width: none; padding: 0; font-size: 11pt; } figure, tr { break-inside: avoid; }
  h2, h3 { break-after: avoid; } nav { display: none; } pre { white-space: pre-wrap; } }
)css";

}  // namespace turbid
