"""Installed packages that offer methods: where their files lie, for what reads a method's file and for what runs it."""
import importlib.metadata
import pathlib
import sys
from typing import Optional


def folders() -> list[str]:
    """Where this interpreter has packages that declare methods; metadata is read, and nothing of them imported."""
    found = importlib.metadata.distributions(path=sys.path[1:])  # not where it was started
    return sorted({str(one.locate_file("")) for one in found if one.entry_points.select(group="lgabench.methods")})


def site_of(file: pathlib.Path) -> Optional[pathlib.Path]:
    """The folder that the package of this file was installed into, which has its *.dist-info; None for any other file."""
    folder = next(folder for folder in file.parents if not (folder / "__init__.py").is_file() or folder == folder.parent)
    try:
        return folder if any(folder.glob("*.dist-info")) else None
    except OSError:  # not to be listed: no site-packages of this interpreter
        return None


def files_of(site: pathlib.Path, file: pathlib.Path) -> list[pathlib.Path]:
    """All source files of the package that holds the file, or the file alone."""
    top = site / file.relative_to(site).parts[0]
    return sorted(path for path in top.rglob("*.py") if path.is_file()) if top.is_dir() else [file]


def module_of(site: pathlib.Path, file: pathlib.Path) -> str:
    """The name that it is imported by."""
    parts = file.relative_to(site).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
