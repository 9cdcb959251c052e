"""Models made elsewhere, from files: .npz, .mat, a folder of Matrix Market files. See `matrix_model` for
names.

.npz: arrays by their names, `numpy.savez("brake.npz", M=M, K=K, K_mu=K_mu, mu=0.4)`; sparse ones as
`save_matrices` writes them (CSR: "K.data", "K.indices", "K.indptr"). .mat: variables of those names (MATLAB 5
to 7.2: `save -v7`), sparse or full. Folder: M.mtx, K_mu.mtx, … (or .mtx.gz), and model.toml with what is not
a matrix::

    name = "drum"
    freedoms = ["shoe.x", "drum.x"]
    [quantities]
    mu = 0.4
    [[groups]]
    name = "lining"
    title = "Lining stiffness"
    both = ["part.K_mu"]          # or leading = [...], trailing = [...]

In .npz and .mat the texts `name`, `freedoms` and `groups` (the list of tables above, as JSON) do the same.

How to bring a finite-element model
-----------------------------------
1. Static solution of the pressed, sliding brake in your package, contact closed; then write the matrices of
   the linearised model, friction contact included (the unsymmetric stiffness), restricted to free degrees of
   freedom: Abaqus `*MATRIX GENERATE, STIFFNESS, MASS, VISCOUS DAMPING` and `*MATRIX OUTPUT,
   FORMAT=COORDINATE` (unsymmetric solver, rows "row column value"); NASTRAN a DMAP alter with `OUTPUT4 KAA,
   MAA, BAA` (pyNastran's `read_op4`); Ansys `*SMAT` and `*EXPORT, …, MMF` (Matrix Market).
2. Do it twice, at mu = 0 and at mu1: K = K(0), K_mu = (K(mu1) - K(0)) / mu1, D_mu alike. A third run at
   another pressure gives K_p in the same way. Write all digits:
   differences keep only what the runs have beyond each other.
3. In Python: `coo = numpy.loadtxt("K.mtx")`, `K = scipy.sparse.coo_array((coo[:, 2], (coo[:, 0].astype(int) -
   1, coo[:, 1].astype(int) - 1)))`, then `foreign.save_matrices("brake.npz", {"M": M, "K": K, "K_mu": K_mu},
   {"mu": 0.4})`. Or a folder with M.mtx, K.mtx, K_mu.mtx and model.toml; or `save brake.mat M K K_mu mu -v7`.
4. More than some thousand degrees of freedom, or massless ones: reduce first (Craig and Bampton keeps contact
   nodes).

NOT its job: the naming scheme and sums of parts (`matrix_model`), checks of matrices (`foreign_checks`).
"""

from __future__ import annotations

import json
import tomllib
import zipfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from scipy import io, sparse

from sim_hardware.brake_model.foreign.matrix_model import MatrixModel, is_part
from sim_hardware.brake_model.linear import ParameterGroup

__all__ = ["MatrixModel", "load_matrices", "save_matrices"]

_SPARSE = ("data", "indices", "indptr")


def load_matrices(path: str | Path) -> MatrixModel:
    """Read a model made elsewhere.

    Raises
    ------
    OSError, tomllib.TOMLDecodeError
        not readable, model.toml is not TOML
    ValueError
        not such a file, or refused (see `MatrixModel`)
    """
    path = Path(path)
    if path.is_dir():
        content = _folder(path)
    elif path.suffix == ".npz":
        content = _npz(path)
    elif path.suffix == ".mat":
        content = _mat(path)
    else:
        path.stat()  # "no such file" comes before "no such kind"
        raise ValueError("not a model: give a .npz or .mat file, or a folder of .mtx files")
    name = str(content.pop("name", path.stem))
    freedoms = content.pop("freedoms", None)
    groups = content.pop("groups", None)
    parts = {key: content.pop(key) for key in list(content) if is_part(key)}
    numbers: dict[str, float] = {}
    for key, value in content.items():
        array = np.asarray(value)
        if array.size != 1 or array.dtype.kind not in "biuf":
            raise ValueError(
                f"{key!r} is neither a matrix (M, D, K, K_mu, D_k_p, …) nor a number; rename or remove it"
            )
        numbers[key] = float(array.reshape(()))
    model = MatrixModel(name, parts, numbers, freedoms)
    return model if groups is None else MatrixModel(name, parts, numbers, freedoms, _groups(groups, model))


def save_matrices(
    path: str | Path,
    parts: Mapping[str, Any],
    numbers: Mapping[str, float] | None = None,
    *,
    name: str | None = None,
    freedoms: Sequence[str] | None = None,
    groups: Sequence[Mapping[str, Any]] = (),
) -> MatrixModel:
    """Write a .npz that `load_matrices` reads; returns the model, checked before anything is written.

    `groups`: tables with name, title and members, as in model.toml.
    """
    path = Path(path)
    if path.suffix != ".npz":
        raise ValueError(f"{path.name}: the file's name must end with .npz")
    model = MatrixModel(name or path.stem, parts, numbers, freedoms)
    _groups(groups, model)
    content: dict[str, Any] = {
        "name": np.array(model.name),
        **{k: np.array(v) for k, v in (numbers or {}).items()},
    }
    if freedoms is not None:
        content["freedoms"] = np.array(list(freedoms))
    if groups:
        content["groups"] = np.array(json.dumps([dict(group) for group in groups]))
    for key, matrix in parts.items():
        if sparse.issparse(matrix):
            rows = sparse.csr_array(matrix)
            content |= {f"{key}.{field}": getattr(rows, field) for field in _SPARSE}
        else:
            content[key] = np.asarray(matrix)
    np.savez_compressed(path, **content)
    return model


def _npz(path: Path) -> dict[str, Any]:
    content: dict[str, Any] = {}
    try:
        with np.load(path, allow_pickle=False) as archive:
            arrays = {key: archive[key] for key in archive.files}
    except (zipfile.BadZipFile, EOFError) as error:
        raise ValueError("not an .npz file; write it with numpy.savez or save_matrices") from error
    except ValueError as error:
        if "pickle" in str(error).lower():
            raise ValueError(
                "holds Python objects or is no .npz; write plain arrays (sparse ones with save_matrices)"
            ) from error
        raise
    for key, array in arrays.items():
        stem, _, field = key.partition(".")
        if not field:
            content[key] = array if is_part(key) else array.tolist()
        elif field not in _SPARSE or any(f"{stem}.{other}" not in arrays for other in _SPARSE):
            raise ValueError(f"{key!r}: a sparse matrix needs {', '.join(f'{stem}.{f}' for f in _SPARSE)}")
        elif field == "data":
            triple = tuple(arrays[f"{stem}.{other}"] for other in _SPARSE)
            n = len(triple[2]) - 1
            try:
                content[stem] = sparse.csr_array(triple, shape=(n, n))
                content[stem].check_format(full_check=True)
            except (ValueError, TypeError) as error:
                raise ValueError(f"the sparse matrix {stem} is damaged: {error}") from error
    if isinstance(content.get("groups"), str):
        content["groups"] = _json(content["groups"])
    return content


def _mat(path: Path) -> dict[str, Any]:
    try:
        variables = io.loadmat(path, chars_as_strings=True)
    except NotImplementedError as error:
        raise ValueError("a MATLAB 7.3 (HDF5) file; save it with `save file.mat … -v7`") from error
    except (ValueError, TypeError, EOFError, io.matlab.MatReadError) as error:
        raise ValueError(f"not a MATLAB file: {error}") from error
    content: dict[str, Any] = {}
    for key, value in variables.items():
        if key.startswith("__"):
            continue
        if is_part(key):
            content[key] = value
        elif key in {"name", "freedoms", "groups"}:
            texts = [str(np.asarray(item).item()).strip() for item in np.asarray(value).ravel()]
            content[key] = texts if key == "freedoms" else "".join(texts)
        else:
            content[key] = value
    if "groups" in content:
        content["groups"] = _json(content["groups"])
    return content


def _folder(path: Path) -> dict[str, Any]:
    content: dict[str, Any] = {}
    for file in sorted([*path.glob("*.mtx"), *path.glob("*.mtx.gz")]):
        key = file.name.split(".")[0]
        if not is_part(key):
            raise ValueError(f"{file.name}: no matrix is called {key!r}; names are M, D, K, K_mu, D_k_p, …")
        if key in content:
            raise ValueError(f"{file.name}: the matrix {key} is there twice; remove one")
        try:
            content[key] = io.mmread(file, spmatrix=False)
        except (ValueError, OverflowError) as error:
            raise ValueError(f"{file.name}: not a Matrix Market file: {error}") from error
    if not content:
        raise ValueError("the folder holds no .mtx files; give M.mtx and K.mtx at least")
    about = path / "model.toml"
    if about.exists():
        with about.open("rb") as stream:
            table = tomllib.load(stream)
        unknown = sorted(set(table) - {"name", "freedoms", "quantities", "groups"})
        if unknown:
            raise ValueError(
                f"model.toml: unknown key {unknown[0]!r}; known: name, freedoms, quantities, groups"
            )
        numbers = table.pop("quantities", {})
        content |= {**table, **numbers}
    return content


def _json(text: str) -> Any:
    try:
        return json.loads(text)
    except json.JSONDecodeError as error:
        raise ValueError(f"`groups` is not JSON: {error}") from error


def _groups(tables: Any, model: MatrixModel) -> tuple[ParameterGroup, ...]:
    """Parameter groups of a list of tables, members checked."""
    groups = []
    known = {"name", "title", "leading", "trailing", "both"}
    for table in tables:
        if not isinstance(table, Mapping) or not {"name"} <= set(table) <= known:
            raise ValueError(
                f"groups: {table!r} is no table with name and some of {', '.join(sorted(known - {'name'}))}"
            )
        leading, trailing, both = (
            tuple(map(str, table.get(key, ()))) for key in ("leading", "trailing", "both")
        )
        members = (*leading, *trailing, *both)
        if not members or bool(leading) != bool(trailing):
            raise ValueError(f"group {table['name']!r}: name members in both, or in leading and trailing")
        for member in members:
            if member not in model.quantities:
                near = ", ".join(model.quantities)
                raise ValueError(
                    f"group {table['name']!r}: the model has no quantity {member!r}; it has: {near}"
                )
        kind = model.quantities[members[0]].kind
        groups.append(
            ParameterGroup(
                str(table["name"]), str(table.get("title", table["name"])), kind, leading, trailing, both
            )
        )
    return tuple(groups)
