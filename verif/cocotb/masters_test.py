"""Tests of the card with third-party bus masters, whose authors knew the buses' specifications but not this project:
cocotbext-axi's AXI4-Lite master and cocotbext-wishbone's pipelined one, each alone and both at once."""
import itertools
import os
import random
import re

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import ClockCycles, Combine, RisingEdge
from cocotbext.axi import AxiLiteBus, AxiLiteMaster, AxiResp
from cocotbext.wishbone.driver import WBOp, WishboneMaster

SEED = int(os.environ.get("TRAMMEL_SEED", "1"))
with open(os.environ["TRAMMEL_CARD_MAP"], encoding="ascii") as card_map:
    TEXT = card_map.read()
MAP = {name: int(value, 16) for name, value in re.findall(
    r"localparam logic \[\d+:0\] (\w+) = \d+'h([0-9A-F]+);", TEXT)}
STRIDES = {name: int(value) for name, value in re.findall(r"localparam int STRIDE_(\w+) = (-?\d+);", TEXT)}
AXES = 4
OKAY, SLVERR = True, False


def address(name, axis=0):
    return MAP[f"ADDR_{name}"] + STRIDES.get(name, 0) * axis


class Axi:
    def __init__(self, dut):
        self.master = AxiLiteMaster(AxiLiteBus.from_prefix(dut, "axi"), dut.clk, dut.rst)

    async def read(self, at):
        answer = await self.master.read(at, 4)
        return answer.resp == AxiResp.OKAY, int.from_bytes(answer.data, "little")

    async def write(self, at, value, size=4):
        answer = await self.master.write(at, value.to_bytes(4, "little")[:size])
        return answer.resp == AxiResp.OKAY

    def stumble(self, dice):
        """Makes every channel pause at random: idle clocks between accesses, answers that are not accepted at once."""
        write, read = self.master.write_if, self.master.read_if
        for channel in (write.aw_channel, write.w_channel, write.b_channel, read.ar_channel, read.r_channel):
            channel.set_pause_generator(dice.random() < 0.4 for _ in itertools.count())


class Wishbone:
    def __init__(self, dut):
        self.master = WishboneMaster(dut, "wb", dut.clk, width=32, timeout=1000)

    async def access(self, operation):
        result, = await self.master.send_cycle([operation])
        return result.ack == 1, result.datrd

    async def read(self, at):
        good, data = await self.access(WBOp(adr=at))
        return good, int(data)

    async def write(self, at, value, size=4):
        return (await self.access(WBOp(adr=at, dat=value, sel=(1 << size) - 1)))[0]


async def start(dut):
    cocotb.start_soon(Clock(dut.clk, 2, units="step").start())
    dut.rst.value = 1
    masters = Axi(dut), Wishbone(dut)
    await ClockCycles(dut.clk, 5)
    dut.rst.value = 0
    await ClockCycles(dut.clk, 2)
    return masters


async def identify(bus):
    for name, value in (("MAGIC", MAP["RESET_MAGIC"]), ("MAP_VERSION", MAP["RESET_MAP_VERSION"]), ("AXES", AXES),
                        ("CLOCK_HZ", 50_000_000), ("GEOMETRY_DEPTH", 4096), ("FEED_DEPTH", 2560)):
        assert await bus.read(address(name)) == (OKAY, value), name


async def refusals(bus):
    assert not await bus.write(address("MAGIC"), 1), "read-only"
    assert (await bus.read(0xFFC)) == (SLVERR, 0), "no register"
    assert not await bus.write(0xFFC, 1), "no register"
    assert (await bus.read(address("CONTROL")))[0] == SLVERR, "write-only"
    assert not await bus.write(address("STEP_LENGTH"), 5, size=2), "half a word"
    assert not await bus.write(address("STEP_LENGTH"), 0x10000), "too large"
    assert await bus.read(address("STEP_LENGTH")) == (OKAY, 0), "nothing changed"
    first = (await bus.read(address("REFUSAL")))[1]
    assert first != 0
    assert await bus.write(address("REFUSAL"), first)
    assert await bus.read(address("REFUSAL")) == (OKAY, 0)


async def settings_at_random(bus, axes, dice, count, tally):
    """Writes and reads settings; every read must return the value that this master wrote last."""
    places = [address(name, axis) for name in ("STEP_LENGTH", "STEP_SPACE", "DIR_SETUP", "DIR_HOLD") for axis in axes]
    held = {}
    for _ in range(count):
        place = dice.choice(places)
        if dice.random() < 0.5:
            value = dice.randrange(0x10000)
            assert await bus.write(place, value), hex(place)
            held[place] = value
        else:
            assert await bus.read(place) == (OKAY, held.get(place, 0)), hex(place)
        tally.append(place)
    for place, value in held.items():
        assert await bus.read(place) == (OKAY, value), hex(place)


class Steps:
    """Counts rising edges at the STEP pins, by axis, with the direction pin's sign."""

    def __init__(self, dut):
        self.position = [0] * AXES
        cocotb.start_soon(self.watch(dut))

    async def watch(self, dut):
        before = 0
        while True:
            await RisingEdge(dut.clk)
            levels = int(dut.step.value)
            if levels & ~before:
                signs = int(dut.dir.value)
                for axis in range(AXES):
                    if (levels & ~before) >> axis & 1:
                        self.position[axis] += 1 if signs >> axis & 1 else -1
            before = levels


async def line(bus, dut, pulses, clocks):
    """Sends a line in one burst of writes; returns the positions that the card counts."""
    for axis in reversed(range(AXES)):
        frequency = ((abs(pulses[axis]) << 40) * 2 + clocks) // (2 * clocks)
        for name, value in (("FREQUENCY_LO", frequency & 0xFFFFFFFF), ("FREQUENCY_HI", frequency >> 32),
                            ("COUNT", abs(pulses[axis])), ("DIRECTION", int(pulses[axis] < 0))):
            assert await bus.write(address(name, axis), value), name
    assert await bus.write(address("LENGTH_LO"), clocks)
    assert await bus.write(address("LENGTH_HI"), 0)
    assert await bus.write(address("START"), sum(1 << axis for axis in range(AXES) if pulses[axis]))
    assert not await bus.write(address("START"), 1), "busy"
    while (await bus.read(address("STATUS")))[1] & 1:
        pass
    assert await bus.write(address("CONTROL"), 1)
    await ClockCycles(dut.clk, 100)
    return [((await bus.read(address("SNAP_POSITION", axis)))[1] ^ 1 << 31) - (1 << 31) for axis in range(AXES)]


@cocotb.test(timeout_time=20_000, timeout_unit="step")
async def each_master_alone(dut):
    for bus in await start(dut):
        await identify(bus)
        await refusals(bus)


@cocotb.test(timeout_time=60_000, timeout_unit="step")
async def a_line_by_each(dut):
    buses = await start(dut)
    steps = Steps(dut)
    place = [0] * AXES
    for bus, pulses in zip(buses, ([20, -40, 0, 7], [-5, 60, 13, 0])):
        place = [a + b for a, b in zip(place, pulses)]
        assert await line(bus, dut, pulses, 2000) == place
        await ClockCycles(dut.clk, 50)
        assert [abs(p) for p in steps.position] == [abs(p) for p in place], (steps.position, place)


@cocotb.test(timeout_time=400_000, timeout_unit="step")
async def both_at_once_and_stumbling(dut):
    axi, wishbone = await start(dut)
    dice = random.Random(SEED)
    axi.stumble(dice)
    tally = []
    # Two tasks on the AXI master, so that reads and writes overlap; each master and task has its own axes.
    tasks = [cocotb.start_soon(settings_at_random(bus, axes, dice, count, tally))
             for bus, axes, count in ((axi, [0], 600), (axi, [1], 600), (wishbone, [2, 3], 900))]
    await Combine(*tasks)
    dut._log.info("%d accesses of foreign masters, each answered as it should be", len(tally))
    assert len(tally) == 2100
