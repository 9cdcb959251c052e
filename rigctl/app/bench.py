"""`rigctl bench …`: the emulated rig behind real wires, its status, and faults on purpose.

Job: the commands, the live line, words for what a running bench says. Not its job: the bench
(`sim_hardware.bench`), which is loaded only when one of these commands runs.
"""

from __future__ import annotations

import json
import signal
import threading
from pathlib import Path
from typing import Annotated, Any

import typer
import typer.core
from rich.console import Console
from rich.live import Live
from rich.markup import escape
from rich.text import Text

from rigctl.app import exit_codes
from rigctl.app.fields import parsed_fields
from rigctl.hal.bench_paths import bench_folder

DEFAULT_BENCH = Path("configs/benches/a_class.toml")
_REFRESH_S = 0.5
_RUN = "run"
_EXAMPLES = """\b
rigctl bench fault rig estop pressed=true
rigctl bench fault rig doors open=true
rigctl bench fault rig condition disc_degc=120
rigctl bench fault drive unplug for_s=2
rigctl bench fault drive fault kind=corrupt probability=0.01
rigctl bench fault pyrometer power on=false
rigctl bench fault can disturb node=current_input wire=broken
rigctl bench fault can disturb node=amplifier channel=1 broken=true
rigctl bench fault can power node=regulator on=false
rigctl bench fault can fault kind=reboot node=0x10 outage_ms=500
rigctl bench fault can fault kind=drop node=32 probability=0.1
rigctl bench fault can clear"""


class _BenchGroup(typer.core.TyperGroup):
    """`rigctl bench FILE` is short for `rigctl bench run FILE`."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """See click."""
        if not args or (args[0] not in self.commands and args[0] not in ctx.help_option_names):
            args = [_RUN, *args]
        return super().parse_args(ctx, args)


def register(app: typer.Typer) -> None:
    """Add `rigctl bench` to the command line."""
    bench = typer.Typer(
        name="bench",
        cls=_BenchGroup,
        help="The emulated rig behind real wires: serial ports, CAN bus, sound card.\n\n"
        "Start with:  rigctl bench",
        rich_markup_mode="rich",
    )
    bench.command(_RUN)(_run)
    bench.command("status")(_status)
    bench.command("fault", epilog=f"Examples:\n\n{_EXAMPLES}")(_fault)
    app.add_typer(bench)


def _run(
    config: Annotated[Path, typer.Argument(help="Bench file.", show_default=True)] = DEFAULT_BENCH,
    seed: Annotated[
        int | None,
        typer.Option("--seed", min=0, max=2**31 - 1, help="Of noise and scatter. [default: bench file]"),
    ] = None,
) -> None:
    """Run a bench until Ctrl-C: plant, serial devices, CAN nodes and microphone on wires of this machine."""
    from sim_hardware.bench.process import CHECK_S, Bench
    from sim_hardware.bench.settings import load_bench

    console = Console(soft_wrap=True)
    stop = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: stop.set())
    bench = Bench(load_bench(config), seed=seed)
    with console.status("The bench starts: physics are compiled the first time (up to some minutes) …"):
        bench.start()
    try:
        _show_wires(console, bench.description())
        if console.is_terminal:
            with Live(console=console, auto_refresh=False, transient=True) as live:
                while not stop.wait(_REFRESH_S):
                    bench.check()
                    live.update(
                        Text(live_line(bench.status()), no_wrap=True, overflow="ellipsis"), refresh=True
                    )
        else:
            while not stop.wait(CHECK_S):
                bench.check()
    finally:
        bench.stop()
    console.print("The bench has stopped; its wires are dead.")
    raise typer.Exit(exit_codes.OK)


def _status(
    as_json: Annotated[bool, typer.Option("--json", help="Everything, as JSON.")] = False,
) -> None:
    """What a running bench says of itself: ports, bus, microphone, values, faults in force."""
    from sim_hardware.bench.commands import ask

    answer = ask(bench_folder(), {"to": "bench", "do": "status"})
    if as_json:
        print(json.dumps(answer, indent=1))
        return
    console = Console(soft_wrap=True)
    _show_wires(console, answer)
    for name, node in answer["can"]["nodes"].items():
        _row(console, f"node {node['node']:#04x}", name, node["state"].lower().replace("_", "-"))
    for name, port in answer["serial"].items():
        words = f"{port['bytes_in']} B in, {port['bytes_out']} B out"
        _row(console, "port", name, words if port["plugged"] else f"UNPLUGGED, {words}")
        for fault in port["faults"]:
            console.print(f"fault at {name}: {escape(json.dumps(fault))}")
    for number, rule in answer["can"]["faults"].items():
        console.print(f"CAN fault {number}: {escape(json.dumps(rule))}")
    console.print(escape(live_line(answer)))


def _fault(
    target: Annotated[str, typer.Argument(help="rig, can, or the name of a serial port.")],
    action: Annotated[str, typer.Argument(help="What to do there; see the examples.")],
    fields: Annotated[
        list[str] | None, typer.Argument(metavar="[KEY=VALUE]...", help="How, e.g. for_s=2.")
    ] = None,
) -> None:
    """Make something go wrong on the running bench, or mend it."""
    from sim_hardware.bench.commands import ask

    request = {"to": target, "do": action, **parsed_fields(fields or [], command="rigctl bench fault")}
    answer = ask(bench_folder(), request)
    print(json.dumps(answer) if answer else "done")


def live_line(status: dict[str, Any]) -> str:
    """One line of a status: values, relay, wires, load."""
    now, inputs, bus, sound = status["outputs"], status["inputs"], status["can"], status["sound"]
    minutes, seconds = divmod(int(status["uptime_s"]), 60)
    nodes = bus["nodes"].values()
    operational = sum(node["state"] == "OPERATIONAL" for node in nodes)
    parts = [
        f"{minutes}:{seconds:02d}",
        f"{_rounded(now['speed_rpm'], 1)} 1/min  {_rounded(now['pressure_bar'], 2)} bar  "
        f"{_rounded(now['torque_nm'], 0)} N·m  {_rounded(now['disc_temperature_degc'], 0)} °C",
        f"relay {'closed' if inputs['relay_closed'] else 'open'}"
        + ("" if inputs["estop_ok"] else ", E-STOP")
        + ("" if inputs["doors_ok"] else ", DOORS OPEN"),
        f"bus {operational} of {len(nodes)} operational, {bus['sent']} frames",
    ]
    faults = len(bus["faults"]) + sum(len(port["faults"]) for port in status["serial"].values())
    parts += [f"{name} UNPLUGGED" for name, port in status["serial"].items() if not port["plugged"]]
    if faults:
        parts.append(f"faults in force: {faults}")
    if sound:
        parts.append("sound " + (sound["failure"] or ("is recorded" if sound["recording"] else "ready")))
    parts.append(f"{status['cpu_percent']:.0f} % CPU, {status['plant']['latest_ms']:.1f} ms late")
    return " | ".join(parts)


def _rounded(value: float, digits: int) -> str:
    """Without "-0"."""
    return f"{round(value, digits) + 0.0:.{digits}f}"


def _show_wires(console: Console, description: dict[str, Any]) -> None:
    """How to reach everything."""
    d = description
    console.print(f"[bold]{escape(d['name'])}[/bold], seed {d['seed']}, process {d['pid']}", highlight=False)
    for name, address in d["ports"].items():
        _row(console, "serial port", f"bench:{name}", address)
    bus = ", ".join(f"{key} = {value}" for key, value in d["bus"].items())
    _row(console, "CAN bus", "", bus)
    if m := d["microphone"]:
        words = f"{m['rate_hz']} Hz, {m['format']}, full scale {m['full_scale_pa']:g} Pa"
        _row(console, "microphone", m["device"], words)
        for name, value in m["environment"].items():
            _row(console, "", "", f"{name}={value}")
    for note in d["notes"]:
        console.print(escape(note))


def _row(console: Console, kind: str, name: str, words: str) -> None:
    console.print(f"{kind:12}{name:17}{words}", highlight=False, markup=False)
