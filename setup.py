"""setup.py - what pyproject.toml cannot say: make builds libradiosity.a, and cffi an extension that holds it.

The engine is linked into the extension, so that there is no second file to find when it is imported; of the
system it needs what the archive is linked with (Embree). BUILD names another build folder, as it does
to make; CC, where it is set, is make's too. What setuptools leaves behind stays below the build folder.
SPDX-License-Identifier: MIT
"""
import os
import re
import shlex
import subprocess

from setuptools import setup
from setuptools.command.build_ext import build_ext

BUILD = os.environ.get("BUILD", "build")
WORK = os.path.join(BUILD, "python")
os.makedirs(WORK, exist_ok=True)


class BuildOverLibrary(build_ext):
    def run(self):
        archive = os.path.join(BUILD, "libradiosity.a")
        compiler = ["CC=" + os.environ["CC"]] if os.environ.get("CC") else []
        command = ["make", "BUILD=" + BUILD, *compiler, archive]
        parallel = [] if "MAKEFLAGS" in os.environ else [f"-j{os.cpu_count() or 1}"]
        try:
            subprocess.run(command + parallel, check=True)
        except (OSError, subprocess.CalledProcessError) as error:
            raise SystemExit(f"setup.py: error: {shlex.join(command)} failed ({error}); see README.md for the "
                             "packages that the library needs, or run `make` first, which installs them")
        super().run()


def version():
    with open("runtime/radiosity.h") as header:
        return re.search(r'#define RADIOSITY_VERSION "(.*)"', header.read()).group(1)


setup(
    version=version(),
    packages=["radiosity"],
    package_dir={"": "python"},
    cffi_modules=["python/binding.py:binding"],
    cmdclass={"build_ext": BuildOverLibrary},
    options={"build": {"build_base": WORK}, "egg_info": {"egg_base": WORK}},
)
