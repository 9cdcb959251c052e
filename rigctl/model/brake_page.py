"""Modes of a brake as one self-contained page: SVG drawn and moved by a script of its own, no other files.

Job: the page's data and text. NOT its job: where bodies stand (`brake_drawing`), painting figures.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape
from string import Template
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rigctl.model.brake_drawing import Drawing
from rigctl.model.brake_painting import Motions, body_colours, ground_path, label_of


@dataclass(frozen=True, slots=True)
class PageMode:
    """A mode of the page: number, heading, facts as lines of text, motions."""

    number: int
    heading: str
    facts: Sequence[str]
    motions: Motions


def modes_page(title: str, picture: Drawing, modes: Sequence[PageMode], shown: int) -> str:
    """Return the page (HTML) with all modes to choose from, `shown` (number) at first."""
    data = {"bodies": _bodies(picture), "springs": _springs(picture), "modes": [_mode(m) for m in modes]}
    first = next(k for k, mode in enumerate(modes) if mode.number == shown)
    x0, x1, y0, y1 = picture.box
    room = 0.07 * picture.size
    disc = next((b for b in picture.bodies if b.role == "disc"), None)
    arrow = ""
    if disc is not None:
        x, y = float(disc.parts[0][:, 0].min()), -float(disc.parts[0][:, 1].max()) - 0.025 * picture.size
        tip, head = x + 0.13 * picture.size, 0.012 * picture.size
        arrow = (
            f'<path class="arrow" '
            f'd="M{x} {y}H{tip}m{-head} {-head / 2}l{head} {head / 2}l{-head} {head / 2}"/>'
            f'<text x="{x}" y="{y - head}" class="small">disc moves</text>'
        )
    return Template(_PAGE).substitute(
        title=escape(title),
        box=f"{x0 - room} {-(y1 + room)} {x1 - x0 + 2 * room} {y1 - y0 + 2 * room}",
        size=picture.size,
        arrow=arrow,
        first=first,
        data=json.dumps(data, separators=(",", ":"), allow_nan=False).replace("</", "<\\/"),
    )


def _bodies(picture: Drawing) -> list[dict[str, Any]]:
    looks = body_colours(picture)
    return [
        {
            "name": b.name, "text": label_of(b.name), "fill": looks[b.name][0], "edge": looks[b.name][1],
            "centre": _list(b.centre), "label": _list(b.label), "left": b.role == "disc",
            "parts": [_list(p) for p in b.parts], "bridge": None if b.bridge is None else _list(b.bridge),
        }
        for b in picture.bodies
    ]  # fmt: skip


def _springs(picture: Drawing) -> list[dict[str, Any]]:
    found = []
    for s in picture.springs:
        ground = None
        if not s.second[0] and s.kind != "torsion":
            path = ground_path(s.first[1], s.second[1], 0.03 * picture.size)
            ground = [_list(path[k : k + 2]) for k in range(0, len(path), 3)]
        ends = [{"body": name, "at": _list(place)} for name, place in (s.first, s.second)]
        found.append({"coupling": s.coupling, "kind": s.kind, "ends": ends, "ground": ground})
    return found


def _mode(mode: PageMode) -> dict[str, Any]:
    motions: Mapping[str, NDArray[np.complex128]] = mode.motions.bodies
    return {
        "number": mode.number, "heading": mode.heading, "facts": list(mode.facts),
        "scale": mode.motions.scale,
        "motions": {name: [[float(z.real), float(z.imag)] for z in m] for name, m in motions.items()},
        "strain": {name: round(float(share), 5) for name, share in mode.motions.strain.items()},
    }  # fmt: skip


def _list(points: NDArray[np.float64]) -> list[Any]:
    return np.round(points, 6).tolist()


_PAGE = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width,
initial-scale=1"> <title>$title</title>
<style>
body{font:15px/1.45 system-ui,"DejaVu Sans",sans-serif;color:#1C2530;margin:0
auto;max-width:1180px;padding:1em} h1{font-size:1.25em;margin:.2em 0 .6em}
main{display:flex;flex-wrap:wrap;gap:1.2em}
svg{flex:1 1 620px;min-width:320px;max-height:78vh;border:1px solid #E6E9ED;border-radius:6px;background:#fff}
aside{flex:0 1 330px}
label{display:block;margin:.55em 0;font-size:.9em}
select,input[type=range]{width:100%}
button{font:inherit;padding:.25em 1.2em}
ul{padding-left:1.1em;margin:.5em 0}
li{margin:.25em 0}
.rest{fill:none;stroke:#7A7A7A;stroke-dasharray:4 3}
.ground{fill:none;stroke:#7A7A7A}
.spring{fill:none;stroke-linejoin:round;stroke-linecap:round}
.arrow{fill:none;stroke:#1C2530}
.name,.small{paint-order:stroke;stroke:#fff;fill:#1C2530}
svg *{vector-effect:non-scaling-stroke}
.note{font-size:.85em;color:#4A5561}
</style></head><body>
<h1>$title</h1>
<main>
<svg id="brake" viewBox="$box" role="img" aria-label="brake, deformed in the chosen mode">$arrow</svg>
<aside>
<label>Mode <select id="mode"></select></label>
<button id="play">pause</button>
<label>Phase <input id="phase" type="range" min="0" max="360" step="1" value="0"></label>
<label>Displacement <input id="scale" type="range" min="0" max="3" step="0.05" value="1"></label>
<label>Speed <input id="speed" type="range" min="0.1" max="2" step="0.05" value="0.6"></label>
<ul id="facts"></ul>
<p class="note">View along the disc's radius: x, in which the disc moves, to the right; y, normal to the
disc, upwards. Dashed: at rest. Springs in red and thick carry most of the strain energy. Displacements are
enlarged; amplitudes are relative.</p>
</aside></main>
<script>
"use strict";
const data=$data, size=$size, svg=document.getElementById("brake"), ns="http://www.w3.org/2000/svg";
const get=id=>document.getElementById(id), add=(tag,cls)=>{const e=document.createElementNS(ns,tag);
 if(cls)e.setAttribute("class",cls);svg.appendChild(e);return e};
const line=(ps,close)=>ps.map((p,i)=>(i?"L":"M")+p[0].toFixed(6)+"
"+(-p[1]).toFixed(6)).join("")+(close?"Z":""); const bodies={};
for(const b of data.bodies)bodies[b.name]=b;
for(const b of data.bodies)if(b.bridge){b.bridgePath=add("path");b.bridgePath.style.cssText=
 `fill:$${b.fill};stroke:$${b.edge};opacity:.25`}
for(const b of data.bodies){b.paths=b.parts.map(p=>{const e=add("path");e.style.cssText=
 `fill:$${b.fill};stroke:$${b.edge};stroke-width:1.5;fill-opacity:.88`;return e});
 for(const p of b.parts)add("path","rest").setAttribute("d",line(p,true))}
for(const s of data.springs){if(s.ground)for(const g of
s.ground)add("path","ground").setAttribute("d",line(g));
 s.path=add("path","spring")}
for(const b of data.bodies){b.text_=add("text","name");b.text_.textContent=b.text;
 b.text_.style.cssText=`font-size:$${size*.017}px;stroke-width:3px;text-anchor:$${b.left?"start":"middle"}`}
for(const e of svg.querySelectorAll(".small"))e.style.cssText=`font-size:$${size*.017}px;stroke-width:3px`;
function zigzag(a,b,kind){const amp=size*.012;if(kind=="torsion"){const out=[];for(let k=0;k<40;k++){
  const w=3.5*Math.PI*k/39,r=amp*(.25+1.3*k/39);out.push([a[0]+r*Math.cos(w),a[1]+r*Math.sin(w)])}return out}
 const d=[b[0]-a[0],b[1]-a[1]],l=Math.hypot(d[0],d[1]);if(!l)return[a,b];
 const n=[-d[1]/l,d[0]/l],turns=l<12*amp?4:Math.max(4,Math.floor(l/(2.5*amp))),out=[a];
 const at=(t,s)=>out.push([a[0]+t*d[0]+s*n[0],a[1]+t*d[1]+s*n[1]]);
 at(.14,0);for(let k=1;k<2*turns;k++)at(.14+.72*k/(2*turns),amp*(k%2?1:-1));at(.86,0);out.push(b);return out}
let mode=data.modes[$first],phase=0,playing=true,last=null;
const zero=[[0,0],[0,0],[0,0]];
function now(name,p){const
m=mode.motions[name]||zero,f=mode.scale*get("scale").value,c=Math.cos(p),s=Math.sin(p);
 return m.map(z=>f*(z[0]*c-z[1]*s))}
function moved(b,ps,m){return
ps.map(p=>[p[0]+m[0]-m[2]*(p[1]-b.centre[1]),p[1]+m[1]+m[2]*(p[0]-b.centre[0])])} function draw(){const
m={};for(const b of data.bodies){m[b.name]=now(b.name,phase);
  b.paths.forEach((e,k)=>e.setAttribute("d",line(moved(b,b.parts[k],m[b.name]),true)));
  if(b.bridgePath)b.bridgePath.setAttribute("d",line(moved(b,b.bridge,m[b.name]),true));
  const
  t=moved(b,[b.label],m[b.name])[0];b.text_.setAttribute("x",t[0]);b.text_.setAttribute("y",-t[1]+size*.006)}
 for(const s of data.springs){const e=s.ends.map(q=>q.body?moved(bodies[q.body],[q.at],m[q.body])[0]:q.at);
  if(s.kind=="torsion")e[1]=e[0];
  s.path.setAttribute("d",line(zigzag(e[0],e[1],s.kind)));const q=mode.strain[s.coupling]||0;
  s.path.style.stroke=q>=.08?"#D55E00":"#1C2530";s.path.style.strokeWidth=1.1+3*Math.sqrt(q)}
 get("phase").value=Math.round(phase*180/Math.PI)%360}
function choose(k){mode=data.modes[k];get("facts").replaceChildren(...mode.facts.map(t=>{
 const e=document.createElement("li");e.textContent=t;return e}));draw()}
data.modes.forEach((m,k)=>{const o=document.createElement("option");o.value=k;o.textContent=m.heading;
 get("mode").appendChild(o)});
get("mode").value=$first;
get("mode").onchange=e=>choose(+e.target.value);
get("play").onclick=()=>{playing=!playing;get("play").textContent=playing?"pause":"play"};
get("phase").oninput=e=>{playing=false;get("play").textContent="play";phase=e.target.value*Math.PI/180;draw()};
get("scale").oninput=draw;
function
step(t){if(last!==null&&playing){phase=(phase+2*Math.PI*get("speed").value*(t-last)/1000)%(2*Math.PI);draw()}
 last=t;requestAnimationFrame(step)}
choose($first);requestAnimationFrame(step);
</script></body></html>
"""
