"""Builds libstereopsis.a by cargo for a PlatformIO project, which runs this as the library's
extraScript, or lays out a library for the Arduino IDE, which runs no scripts:

    python3 build_stereopsis.py --cpu cortex-m4 --float hard --out stereopsis

STEREOPSIS_METHOD, STEREOPSIS_WIDTH, STEREOPSIS_DISPARITIES, STEREOPSIS_HEIGHT and
STEREOPSIS_LINES choose what it is built for, as in stereopsis.cmake: in platformio.ini as `custom_stereopsis_width = 160`, else by the environment.
"""

import argparse
import os
import shutil
import subprocess

CHOICES = {"METHOD": "block", "WIDTH": "160", "DISPARITIES": "32", "HEIGHT": "120", "LINES": "33"}

# What the Arduino IDE calls the folder of a core's library for floating-point registers.
UNITS = {
    "cortex-m4": "fpv4-sp-d16-hard",
    "cortex-m7": "fpv5-d16-hard",
    "cortex-m33": "fpv5-sp-d16-hard",
}

# Cores as GCC spells them, Rust's targets, and whether there is one for floating-point registers as well.
TARGETS = {
    "cortex-m0": ("thumbv6m-none-eabi", False),
    "cortex-m0plus": ("thumbv6m-none-eabi", False),
    "cortex-m3": ("thumbv7m-none-eabi", False),
    "cortex-m4": ("thumbv7em-none-eabi", True),
    "cortex-m7": ("thumbv7em-none-eabi", True),
    "cortex-m33": ("thumbv8m.main-none-eabi", True),
    "cortex-m55": ("thumbv8m.main-none-eabi", True),
    "esp32c3": ("riscv32imc-unknown-none-elf", False),
    "esp32c6": ("riscv32imac-unknown-none-elf", False),
}


def rust_target(cpu, hard_float):
    """Rust's name of a core, whatever it is said to lack."""
    core = cpu.split("+")[0]
    if core not in TARGETS:
        raise SystemExit(f"stereopsis: no Rust target for {cpu}; there are {', '.join(TARGETS)}")
    target, has_registers = TARGETS[core]
    return target + ("hf" if hard_float and has_registers else "")


def rust_flags(cpu, hard_float):
    """What a core has beyond its target: cortex-m33+nodsp has no DSP extension, cortex-m55+nomve no vectors.

    Rust's cortex-m33 and cortex-m55 have an FPU, whatever the target is: they are named where the FPU is on, as it is
    where floats are passed in its registers.
    """
    core, *without = cpu.split("+")
    if core not in ("cortex-m33", "cortex-m55") or "nodsp" in without:
        return ""
    if hard_float and core == "cortex-m33":
        return "-C target-cpu=cortex-m33"
    if hard_float and "nomve" not in without:
        return "-C target-cpu=cortex-m55" + (" -C target-feature=-mve.fp" if "nomve.fp" in without else "")
    return "-C target-feature=+dsp"


def core_of(mcu, cpu, flags):
    """A board's core: its chip where that has a name here, else what GCC compiles for."""
    asked = [flag.split("=", 1)[1] for flag in flags if flag.startswith("-mcpu=")]
    return next((name for name in [mcu, *reversed(asked)] if name.split("+")[0] in TARGETS), cpu)


def build(repository, cpu, hard_float, choices, folder):
    """Runs cargo; the path of libstereopsis.a."""
    target = rust_target(cpu, hard_float)
    environment = dict(os.environ, **{f"STEREOPSIS_{name}": value for name, value in choices.items()})
    flags = rust_flags(cpu, hard_float)
    if flags:
        environment["RUSTFLAGS"] = f"{os.environ.get('RUSTFLAGS', '')} {flags}".strip()
    manifest = os.path.join(repository, "examples", "c-firmware", "library", "Cargo.toml")
    command = ["cargo", "build", "--locked", "--release", "--manifest-path", manifest]
    subprocess.run([*command, "--target", target, "--target-dir", folder], check=True, env=environment)
    return os.path.join(folder, target, "release", "libstereopsis.a")


def products(beside):
    """Cargo's folder of build products, which STEREOPSIS_TARGET_DIR names, else one beside the project's."""
    return os.environ.get("STEREOPSIS_TARGET_DIR", os.path.join(beside, "stereopsis-target"))


def definitions(choices):
    """The macros that stereopsis.cmake defines as well."""
    sizes = {f"STEREOPSIS_{name}": choices[name] for name in ("WIDTH", "DISPARITIES", "HEIGHT", "LINES")}
    return {**sizes, "STEREOPSIS_BYTES": f"STEREOPSIS_{choices['METHOD'].upper().replace('-', '_')}_BYTES"}


def in_platformio(env, here):
    """Adds the library to the project that is built."""
    repository = os.path.abspath(os.path.join(here, "..", "..", ".."))
    asked = {name: env.GetProjectOption(f"custom_stereopsis_{name.lower()}", None) for name in CHOICES}
    choices = {n: asked[n] or os.environ.get(f"STEREOPSIS_{n}", d) for n, d in CHOICES.items()}
    board = env.BoardConfig()
    mcu = board.get("build.mcu", "")
    flags = [str(flag) for flag in env.get("CCFLAGS", [])]
    cpu = core_of(mcu, board.get("build.cpu", mcu), flags)
    hard_float = "-mfloat-abi=hard" in flags
    library = build(repository, cpu, hard_float, choices, products(env.subst("$BUILD_DIR")))
    # PlatformIO hands paths and libraries of this environment on to the project, but no macros.
    env.Append(CPPPATH=[os.path.join(repository, "src", "ffi")])
    env.Append(LIBPATH=[os.path.dirname(library)], LIBS=["stereopsis"])
    # The library's panic handler cannot be linked: what nobody calls has to be dropped.
    env.Append(LINKFLAGS=["-Wl,--gc-sections"])
    return definitions(choices)


def for_arduino(repository, here, cpu, hard_float, out):
    """Lays out a library that the Arduino IDE takes from its folder `libraries`."""
    choices = {name: os.environ.get(f"STEREOPSIS_{name}", default) for name, default in CHOICES.items()}
    library = build(repository, cpu, hard_float, choices, products(os.path.join(out, "..", "..")))
    # Where the IDE looks for a core's compiled library.
    core = cpu.split("+")[0]
    place = os.path.join(out, "src", core, UNITS.get(core, "") if hard_float else "")
    os.makedirs(place, exist_ok=True)
    shutil.copy(library, place)
    shutil.copy(os.path.join(here, "library.properties"), out)
    with open(os.path.join(repository, "src", "ffi", "stereopsis.h"), encoding="utf-8") as header:
        text = header.read()
    macros = "".join(f"#define {name} {value}\n" for name, value in definitions(choices).items())
    with open(os.path.join(out, "src", "stereopsis.h"), "w", encoding="utf-8") as header:
        header.write(f"/* What the library was built for. */\n{macros}\n{text}")


def main():
    """The command of the Arduino IDE's users."""
    arguments = argparse.ArgumentParser(description="Lays out a library for the Arduino IDE.")
    arguments.add_argument("--cpu", required=True, help=f"the core: {', '.join(TARGETS)}, and +nodsp or +nomve as GCC has it")
    arguments.add_argument("--float", default="soft", choices=["soft", "hard"], help="how floats are passed")
    arguments.add_argument("--out", required=True, help="the library's folder")
    asked = arguments.parse_args()
    here = os.path.dirname(os.path.abspath(__file__))
    repository = os.path.abspath(os.path.join(here, "..", "..", ".."))
    for_arduino(repository, here, asked.cpu, asked.float == "hard", asked.out)


if __name__ == "__main__":
    main()
else:
    # PlatformIO's scripts run inside SCons, whose functions are there without an import.
    Import("env")  # noqa: F821
    macros = in_platformio(env, os.getcwd())  # noqa: F821
    DefaultEnvironment().Append(CPPDEFINES=list(macros.items()))  # noqa: F821
