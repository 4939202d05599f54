"""Runs a library's extraScript as PlatformIO does, for a board with a Cortex-M4F, and prints what it adds; for another
core, with its compiler's flags, only what cargo is asked for."""

import os
import subprocess
import sys

script, build_folder, *other = sys.argv[1:]
cpu, *flags = other or ["cortex-m4", "-mcpu=cortex-m4", "-mfloat-abi=hard"]


class Environment(dict):
    """A construction environment, as far as the script asks for it."""

    def Append(self, **what):
        for name, values in what.items():
            self.setdefault(name, []).extend(values)

    def GetProjectOption(self, name, default=None):
        return {"custom_stereopsis_height": "240"}.get(name, default)

    def BoardConfig(self):
        return {"build.mcu": "stm32f407vgt6", "build.cpu": cpu}

    def subst(self, text):
        return text.replace("$BUILD_DIR", build_folder)


def show(command, check, env):
    """Stands for `subprocess.run`."""
    print(command[command.index("--target") + 1], env.get("RUSTFLAGS", ""))
    sys.exit()


if other:
    subprocess.run = show
shared, env = Environment(), Environment(CCFLAGS=flags)
os.chdir(os.path.dirname(script))
scope = {"env": env, "Import": lambda name: None, "DefaultEnvironment": lambda: shared}
with open(script, encoding="utf-8") as text:
    exec(compile(text.read(), script, "exec"), {"__name__": "SCons.Script", **scope})
for path in env["CPPPATH"] + env["LIBPATH"]:
    print(path)
print(" ".join(env["LIBS"] + env["LINKFLAGS"]))
print(" ".join(f"{name}={value}" for name, value in shared["CPPDEFINES"]))
