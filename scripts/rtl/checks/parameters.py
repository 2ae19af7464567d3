"""Checks that Verilator, Yosys, Icarus and slang reject illegal parameters of the card, and accept the extreme legal
ones.

To reject them, the RTL instantiates a module that does not exist and whose name is the message. It cannot use `$error`,
because Icarus 11 refuses that in a generate block even if it is not reached."""
from concurrent.futures import ThreadPoolExecutor
from itertools import cycle

from checks import readers

AXES, DEPTH, PORTS = ("ERROR_Axes_must_be_1_to_8", "ERROR_GeometryDepth_and_FeedDepth_must_be_2_to_32768",
                      "ERROR_Ports_must_be_1_to_4")
EIGHT = "ERROR_EightDirections_needs_Accumulator"
NO_PORT = "ERROR_a_card_needs_a_host_port"
BREAK = "ERROR_BreakBits_must_be_8_to_24"
FLAG = "ERROR_engines_and_BuildDirty_must_be_0_or_1"
BUILT = "ERROR_AxiLite_Uart_and_Spi_must_be_0_or_1"
WISHBONE = "ERROR_Wishbone_must_be_0_to_2"
PINS = "ERROR_Inputs_must_be_1_to_32_and_Outputs_1_to_16"
MACHINE = "ERROR_MachineInputs_needs_PathCommands"
CAPTURES = "ERROR_Captures_must_be_0_to_4"
CAPTURES_ALONE = "ERROR_Captures_needs_MachineInputs"
FIFO = "ERROR_CaptureFifo_needs_Captures"
ENABLES = "ERROR_Enables_needs_PathCommands"
SOFT = "ERROR_SoftLimits_needs_MachineInputs"
PWM = "ERROR_Pwm_needs_PathCommands"
FLAGS = ("Accumulator EightDirections ArcGenerator DirectMode UnderrunHold Classes Watermarks PathCommands PositionStreaming "
         "MachineInputs CaptureFifo EmergencyStop Enables SoftLimits Pwm BuildDirty").split()
# Top, parameters, and the message that must stop the reader; None: they are legal.
CASES = [
    ("trammel_card", "Axes=1 GeometryDepth=2 FeedDepth=2", None),
    ("trammel_card", "Axes=8 GeometryDepth=32768 FeedDepth=32768", None),
    ("trammel_card", "GeometryDepth=4095 FeedDepth=3", None),
    ("trammel_card", "Accumulator=0", None),
    ("trammel_card", "EightDirections=1", None),
    ("trammel_card", "EightDirections=1 Axes=8 ArcGenerator=1", None),
    ("trammel_card", "DirectMode=0", None),
    ("trammel_card", "Classes=0", None),
    ("trammel_card", "Watermarks=0", None),
    ("trammel_card", "Axes=1 Accumulator=0 DirectMode=0 Classes=0 Watermarks=0", None),
    ("trammel_card", "ArcGenerator=1", None),
    ("trammel_card", "Axes=1 ArcGenerator=1 Accumulator=0", None),
    ("trammel_card", "Axes=8 ArcGenerator=1", None),
    ("trammel_card", "Axes=1 Accumulator=0 DirectMode=0", None),
    ("trammel_card", "PathCommands=1", None),
    ("trammel_card", "PositionStreaming=1", None),
    ("trammel_card", "PathCommands=1 Inputs=1 Outputs=1", None),
    ("trammel_card", "PathCommands=1 Inputs=32 Outputs=16 Axes=8", None),
    ("trammel_card", "PathCommands=1 MachineInputs=1 Inputs=1", None),
    ("trammel_card", "PathCommands=1 MachineInputs=1 Inputs=32 Axes=8", None),
    ("trammel_card", "MachineInputs=1", MACHINE),
    ("trammel_card", "PathCommands=1 MachineInputs=1 Captures=1", None),
    ("trammel_card", "PathCommands=1 MachineInputs=1 Captures=4 Inputs=32 Axes=8", None),
    ("trammel_card", "PathCommands=1 MachineInputs=1 Captures=5", CAPTURES),
    ("trammel_card", "PathCommands=1 Captures=1", CAPTURES_ALONE),
    ("trammel_card", "PathCommands=1 MachineInputs=1 Captures=1 CaptureFifo=1", None),
    ("trammel_card", "PathCommands=1 MachineInputs=1 Captures=4 CaptureFifo=1 Inputs=32 Axes=8", None),
    ("trammel_card", "PathCommands=1 MachineInputs=1 CaptureFifo=1", FIFO),
    ("trammel_card", "PathCommands=1 MachineInputs=1 SoftLimits=1", None),
    ("trammel_card", "PathCommands=1 MachineInputs=1 SoftLimits=1 Axes=8", None),
    ("trammel_card", "SoftLimits=1", SOFT),
    ("trammel_card", "EmergencyStop=1", None),
    ("trammel_card", "PathCommands=1 EmergencyStop=1 Enables=1 Axes=8 Outputs=16", None),
    ("trammel_card", "Enables=1", ENABLES),
    ("trammel_card", "PathCommands=1 Pwm=1 Outputs=1", None),
    ("trammel_card", "PathCommands=1 Pwm=1 Outputs=16 Axes=8", None),
    ("trammel_card", "Pwm=1", PWM),
    ("trammel_card", "BuildId=305419896 BuildDirty=1 BoardId=1", None),
    ("card_core", "Ports=1", None),
    ("card_core", "Ports=4 Axes=8", None),
    ("trammel_card", "Axes=0", AXES),
    ("trammel_card", "Axes=9", AXES),
    ("trammel_card", "GeometryDepth=1", DEPTH),
    ("trammel_card", "GeometryDepth=32769", DEPTH),
    ("trammel_card", "FeedDepth=1", DEPTH),
    ("trammel_card", "FeedDepth=32769", DEPTH),
    ("trammel_card", "Inputs=0", PINS),
    ("trammel_card", "Inputs=33", PINS),
    ("trammel_card", "Outputs=0", PINS),
    ("trammel_card", "Outputs=17", PINS),
    ("trammel_card", "EightDirections=1 Accumulator=0", EIGHT),
    ("uart_port", "BreakBits=8", None),
    ("uart_port", "BreakBits=24", None),
    ("wishbone_port", "Pipelined=1", None),
    ("host_ports", "Wishbone=1 Uart=1 Spi=1", None),
    ("host_ports", "AxiLite=0 Wishbone=2", None),
    ("host_ports", "AxiLite=0 Uart=1", None),
    ("card_with_ports", "AxiLite=0 Uart=1", None),
    ("card_with_ports", "AxiLite=1 Wishbone=2 Uart=1 Spi=1 Axes=8 PathCommands=1", None),
    *((top, f"{flag}=2", FLAG) for top, flag in zip(cycle(("trammel_card", "card_with_ports")), FLAGS)),
    ("host_ports", "AxiLite=0", NO_PORT),
    ("host_ports", "AxiLite=2", BUILT),
    ("card_with_ports", "Uart=2", BUILT),
    ("card_with_ports", "Spi=3", BUILT),
    ("host_ports", "Wishbone=3", WISHBONE),
    ("card_with_ports", "Wishbone=3", WISHBONE),
    ("card_with_ports", "BreakBits=25 Uart=1", BREAK),
    ("wishbone_port", "Pipelined=2", "ERROR_Pipelined_must_be_0_or_1"),
    ("uart_port", "BreakBits=7", BREAK),
    ("uart_port", "BreakBits=25", BREAK),
    ("card_core", "Ports=0", PORTS),
    ("card_core", "Ports=5", PORTS),
]


def judge(case):
    """The complaints about one case. Linter warnings are off for illegal values, because these also make odd
    vectors."""
    top, text, message = case
    wrong = []
    for reader, command in readers.commands(top, parameters=text.split(), warnings=message is None).items():
        said, good = readers.run(command)
        if message is None and not good:
            wrong.append(f"{reader} refuses {top} {text}:\n{said}")
        elif message is not None and good:
            wrong.append(f"{reader} takes {top} {text}")
        elif message is not None and message not in said:
            wrong.append(f"{reader} stops at {top} {text}, but does not say {message}:\n{said}")
    return wrong


def complaints():
    with ThreadPoolExecutor(2) as pool:
        return sum(pool.map(judge, CASES), [])
