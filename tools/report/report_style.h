#pragma once

namespace misfit::tools {

/// The page's looks: one column of text, pictures side by side where there is room, dark where the reader's system is.
inline constexpr const char* report_style = R"css(
:root { color-scheme: light dark; --text: #1d1d1f; --soft: #62646a; --line: #dcdde1; --page: #ffffff; --tint: #f5f5f7;
  --accent: #88226a; --second: #1f6fa8; --bad: #b3261e; --good: #2b6e3f; --warn: #fff4d6; --warn-line: #e0a100; }
@media screen and (prefers-color-scheme: dark) { :root { --text: #e4e4e7; --soft: #a0a1a8; --line: #34353b; --page: #141417; --tint: #1d1e22;
  --accent: #f0764f; --second: #6db3e8; --bad: #ff8a80; --good: #81c995; --warn: #33290f; --warn-line: #c98f00; } img, .drawing svg, .pictures svg:not(.curve) { filter: brightness(.82); } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--page); color: var(--text); font: 16px/1.5 system-ui, -apple-system, "Segoe UI", "DejaVu Sans", sans-serif; }
main { max-width: 1060px; margin: 0 auto; padding: 2rem 1.25rem 4rem; }
header { display: flex; flex-wrap: wrap; align-items: baseline; justify-content: space-between; gap: 0 1rem; margin-bottom: 1.25rem; }
h1 { font-size: 1.7rem; line-height: 1.2; margin: 0; overflow-wrap: anywhere; }
h2 { font-size: 1.05rem; margin: 2.75rem 0 .6rem; padding-bottom: .35rem; border-bottom: 1px solid var(--line); }
header p, small, th, .none { color: var(--soft); }
header p { margin: 0; }
aside { background: var(--warn); border-left: 4px solid var(--warn-line); padding: .6rem 1rem; margin: 0 0 1.25rem; border-radius: 0 6px 6px 0; }
aside p { margin: .25rem 0; }
.facts { display: flex; flex-wrap: wrap; gap: 1px; margin: 0; background: var(--line);
  border: 1px solid var(--line); border-radius: 8px; overflow: hidden; }
.facts div { flex: 1 1 16rem; background: var(--page); padding: .8rem 1rem; }
.facts dt { font-size: .8rem; color: var(--soft); }
.facts dd { margin: .1rem 0 0; font-size: 1.2rem; line-height: 1.35; font-variant-numeric: tabular-nums; }
small { display: block; font-size: .8rem; }
small.good { color: var(--good); } small.bad { color: var(--bad); }
sup { line-height: 0; font-size: .75em; }
.pictures { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 28rem), 1fr)); gap: 1rem; margin-top: 1.5rem; }
figure { margin: 0; }
img { display: block; width: 100%; height: auto; border: 1px solid var(--line); border-radius: 8px; background: #fff; }
.drawing, .data { margin: 1.25rem 0 2rem; max-width: 48rem; } .data { max-width: none; }
.drawing svg, .pictures svg { display: block; width: 100%; height: auto; border: 1px solid var(--line); border-radius: 8px; background: #fff; }
figcaption { font-size: .92rem; margin: .5rem 0; max-width: 48rem; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-size: .92rem; font-variant-numeric: tabular-nums; }
th { text-align: left; font-weight: 500; font-size: .8rem; }
th, td { padding: .35rem 1rem .35rem 0; border-bottom: 1px solid var(--line); vertical-align: top; }
td:last-child, th:last-child { padding-right: 0; }
.wide td { white-space: nowrap; } .wide td:last-child:not(.number) { white-space: normal; min-width: 11rem; }
.wide th:not(.number), .wide td:not(.number):not(:first-child) { padding-left: .5rem; } th { vertical-align: bottom; }
.narrow { max-width: 34rem; }
.number { text-align: right; white-space: nowrap; }
.s0 { --shade: #88226a; } .s1 { --shade: #1f6fa8; } .s2 { --shade: #e07b2c; } .s3 { --shade: #2b8a6e; } .s4 { --shade: #c94f7c; }
.s5 { --shade: #6db3e8; } .s6 { --shade: #d9b13b; } .s7 { --shade: #a6a8ae; }
.bar { display: block; width: 100%; height: 1.6rem; margin: .9rem 0; border-radius: 4px; } .bar rect { fill: var(--shade); }
.swatch { display: inline-block; width: .75rem; height: .75rem; margin-right: .55rem; border-radius: 2px; background: var(--shade);
  -webkit-print-color-adjust: exact; print-color-adjust: exact; }
.curve { display: block; width: 100%; max-width: 34rem; height: auto; border: 1px solid var(--line); border-radius: 8px; }
.curve .grid { stroke: var(--line); } .curve polyline { fill: none; stroke-width: 2; stroke-linejoin: round; }
.curve .peak { stroke: var(--accent); } .curve .noise { stroke: var(--soft); stroke-width: 1.5; }
.curve .depth { stroke: var(--second); stroke-width: 1.5; stroke-dasharray: 5 3; } .curve .flux { stroke: var(--second); }
.curve circle { fill: var(--accent); } .curve circle.flux { fill: var(--second); stroke: none; }
.curve text { fill: var(--soft); font-size: 12.5px; } .curve .middle { text-anchor: middle; } .curve .end { text-anchor: end; }
.curve .title { fill: var(--text); font-size: 16px; font-weight: 700; }
td code { white-space: nowrap; }
code, pre { font: .88rem/1.5 ui-monospace, "SF Mono", "DejaVu Sans Mono", monospace; }
pre { background: var(--tint); padding: .8rem 1rem; border-radius: 6px; white-space: pre-wrap; overflow-wrap: anywhere; margin: 0; }
td { overflow-wrap: break-word; } p, dd, figcaption { overflow-wrap: anywhere; }
@media (max-width: 36rem) { main { padding: 1.25rem 1rem 3rem; } .facts div { flex-basis: 40%; } .facts dd { font-size: 1.05rem; }
  table { font-size: .85rem; } th, td { padding-right: .7rem; }
  .drawing { overflow-x: auto; } .drawing svg { min-width: 30rem; } }
@media print { :root { color-scheme: light; font-size: 13px; } body { font-size: 1rem; } main { max-width: none; padding: 0; }
  figure, .facts, .bar, tr, aside, pre { break-inside: avoid; } h2, .bar { break-after: avoid; } h2 { margin-top: 2rem; }
  th, td { padding-top: .2rem; padding-bottom: .2rem; } .scroll { overflow: visible; }
  .pictures { grid-template-columns: 1fr 1fr; } .drawing { max-width: none; margin: .5rem 0; }
  .wide table { font-size: .87rem; } .wide th { font-size: .8rem; } .wide th, .wide td { padding-right: .4rem; } }
)css";

}  // namespace misfit::tools
