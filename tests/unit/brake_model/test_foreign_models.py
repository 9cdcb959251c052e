"""Models made elsewhere: names of parts, sums, exact derivatives, formats, refusals that explain."""

import gzip
import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import io, sparse

from sim_hardware.brake_model.foreign.files import MatrixModel, load_matrices, save_matrices
from sim_hardware.brake_model.foreign.matrix_model import DENSE_UP_TO, part_factors
from sim_hardware.brake_model.linear import LinearModel, Matrices

M = np.diag([1.0, 2.0])
K = np.array([[300.0, -100.0], [-100.0, 200.0]])
K_MU = np.array([[0.0, 50.0], [-20.0, 0.0]])
D_KP = np.array([[-1.0, 0.0], [0.0, -2.0]])
PARTS = {"M": M, "K": K, "K_mu": K_MU, "D": 0.01 * K, "D_k_p": D_KP}
NUMBERS = {"mu": 0.4, "slope": 0.05, "pressure": 10.0}


def small(**more: object) -> MatrixModel:
    return MatrixModel("small", {**PARTS, **more}, NUMBERS)


@pytest.mark.parametrize(
    ("name", "powers"),
    [
        ("K", {}),
        ("K_mu", {"mu": 1}),
        ("D_k_p", {"slope": 1, "pressure": 1}),
        ("D_slope_pressure", {"slope": 1, "pressure": 1}),
        ("G_v", {"speed": 1}),
        ("K_v_v", {"speed": 2}),
        ("D_mu_p_per_v", {"mu": 1, "pressure": 1, "speed": -1}),
        ("K_v_per_v", {}),
        ("K_pad_l", {"pad_l": 1}),
        ("K_pad_l_mu", {"pad_l": 1, "mu": 1}),
    ],
)
def test_names_say_what_a_part_is_multiplied_by(name: str, powers: dict[str, int]) -> None:
    assert part_factors(name, {"pad_l": 1.0, "pad": 2.0}).powers == powers


def test_sum_of_parts() -> None:
    model = small()
    assert isinstance(model, LinearModel)
    at = model.matrices({"mu": 0.5, "pressure": 20.0, "part.K_mu": 2.0})
    np.testing.assert_allclose(at.mass, M)
    np.testing.assert_allclose(at.stiffness, K + 2.0 * 0.5 * K_MU)
    np.testing.assert_allclose(at.damping, 0.01 * K + 0.05 * 20.0 * D_KP)
    assert model.freedoms == ("q1", "q2")
    assert model.quantities["pressure"].unit == "bar"
    assert model.quantities["part.D_k_p"].kind == "damping"
    assert model.groups[0].members == ("part.M",)


@given(
    values=st.fixed_dictionaries(
        {"mu": st.floats(0, 2), "speed": st.floats(0.5, 5), "pad": st.floats(0.5, 2)}
    ),
    name=st.sampled_from(["mu", "speed", "pad", "part.K_v_v", "part.D_mu_per_v", "part.M_pad", "part.K"]),
)
def test_derivatives_are_exact(values: dict[str, float], name: str) -> None:
    parts = {
        "M": M,
        "M_pad": 0.1 * M,
        "K": K,
        "K_mu": K_MU,
        "K_v_v": -K_MU,
        "D_mu_per_v": D_KP,
        "G_v": K_MU - K_MU.T,
    }
    model = MatrixModel("m", parts, {"mu": 0.4, "speed": 1.0, "pad": 1.0})
    exact = model.derivative(name, values)
    here = values.get(name, 1.0)
    step = 1e-6
    high, low = (
        (model.matrices({**values, name: here + s}) for s in (step, -step)) if here > step else (None, None)
    )
    if high is None or low is None:
        return
    for field in ("mass", "damping", "stiffness"):
        difference = (getattr(high, field) - getattr(low, field)) / (2 * step)
        np.testing.assert_allclose(getattr(exact, field), difference, rtol=1e-6, atol=1e-5)


def equal(a: Matrices, b: Matrices) -> None:
    for one, two in zip((a.mass, a.damping, a.stiffness), (b.mass, b.damping, b.stiffness), strict=True):
        np.testing.assert_array_equal(*(m.toarray() if sparse.issparse(m) else m for m in (one, two)))


def sparse_parts(n: int) -> dict[str, sparse.csr_array]:
    mass = sparse.csr_array(sparse.diags_array(np.linspace(1, 2, n)))
    stiffness = sparse.csr_array(
        sparse.diags_array([np.full(n - 1, -1.0), np.full(n, 2.5), np.full(n - 1, -1.0)], offsets=[-1, 0, 1])
    )
    return {
        "M": mass,
        "K": stiffness,
        "K_mu": sparse.csr_array(sparse.diags_array([np.ones(n - 1)], offsets=[1])),
    }


@pytest.mark.parametrize("n", [5, DENSE_UP_TO + 20])
def test_formats_agree(tmp_path: Path, n: int) -> None:
    parts, numbers = sparse_parts(n), {"mu": 0.3}
    groups = [{"name": "pads", "title": "Pads", "both": ["part.K_mu"]}]
    freedoms = [f"n{i}.w" for i in range(n)]
    expected = save_matrices(tmp_path / "a.npz", parts, numbers, freedoms=freedoms, groups=groups)
    np.savez(tmp_path / "b.npz", **{k: p.toarray() for k, p in parts.items()}, mu=0.3)
    variables = {
        **parts,
        "mu": 0.3,
        "freedoms": np.array(freedoms, dtype=object),
        "groups": json.dumps(groups),
    }
    io.savemat(tmp_path / "c.mat", {k: v.tocsc() if sparse.issparse(v) else v for k, v in variables.items()})
    folder = tmp_path / "d"
    folder.mkdir()
    for key, part in parts.items():
        io.mmwrite(folder / f"{key}.mtx", part, precision=17)
    packed = folder / "K.mtx"
    (folder / "K.mtx.gz").write_bytes(gzip.compress(packed.read_bytes()))
    packed.unlink()
    names = ", ".join(f'"{f}"' for f in freedoms)
    (folder / "model.toml").write_text(
        f'name = "d"\nfreedoms = [{names}]\n[quantities]\nmu = 0.3\n'
        '[[groups]]\nname = "pads"\ntitle = "Pads"\nboth = ["part.K_mu"]\n'
    )
    for file in ("a.npz", "b.npz", "c.mat", "d"):
        model = load_matrices(tmp_path / file)
        assert model.quantities["mu"].value == 0.3
        for values in (None, {"mu": 0.7}):
            equal(model.matrices(values), expected.matrices(values))
        assert model.matrices().is_sparse == (n > DENSE_UP_TO)
        if file != "b.npz":
            assert list(model.freedoms) == freedoms
            assert [(g.name, g.title, g.both, g.kind) for g in model.groups] == [
                ("pads", "Pads", ("part.K_mu",), "stiffness")
            ]


@pytest.mark.parametrize(
    ("change", "numbers", "message"),
    [
        ({"M": None}, {}, "matrix M is missing"),
        ({"K": None, "K_mu": None}, {}, "matrix K is missing"),
        ({"K": np.eye(3)}, {}, "K is 3 × 3 where the first is 2 × 2"),
        ({"K": np.ones((2, 3))}, {}, "K is 2 × 3"),
        ({"K": np.zeros((0, 0))}, {}, "not empty"),
        ({"K": K * 1j}, {}, "K is complex"),
        ({"K": np.array([[1.0, np.nan], [0.0, 1.0]])}, {}, "row 1, column 2"),
        ({"K": sparse.csr_array([[1.0, 0.0], [np.inf, 1.0]])}, {}, "row 2, column 1"),
        ({"K": np.array([["a", "b"], ["c", "d"]])}, {}, "give numbers"),
        ({"M": np.diag([1.0, 0.0])}, {}, r"'q2' has the inertia 0, .*condensation"),
        ({"M": np.diag([1.0, -2.0])}, {}, r"'q2' has the inertia -2, .*sign"),
        ({"M": np.ones((2, 2))}, {}, "M is singular"),
        ({"M": np.array([[1.0, 2.0], [2.0, 1.0]])}, {}, "M is not positive"),
        ({"M": np.array([[0.0, 1.0], [0.0, 1.0]])}, {}, "M is singular"),
        ({"K_foo": K}, {}, "factor 'foo' is none of mu"),
        ({"K_": K}, {}, "ends with '_'"),
        ({"Q": K}, {}, "'Q' is no matrix's"),
        ({"G_v": K}, {}, r"multiplied by speed.*add the number speed"),
        ({}, {"pads": 1.0}, "'pads': changing it would do nothing"),
        ({}, {"mu": -0.1}, "number mu is -0.1"),
        ({}, {"mu": np.inf}, "number mu is inf"),
    ],
)
def test_nonsense_is_refused_with_a_remedy(change: dict, numbers: dict, message: str) -> None:
    parts = {k: v for k, v in {**PARTS, **change}.items() if v is not None}
    with pytest.raises(ValueError, match=message):
        MatrixModel("bad", parts, {**NUMBERS, **numbers})


def test_values_are_checked() -> None:
    model = small()
    with pytest.raises(KeyError, match=r"did you mean.*pressure"):
        model.matrices({"presure": 1.0})
    with pytest.raises(KeyError, match=r"part.K_mu"):
        model.derivative("part.K_nu")
    for values, message in (
        ({"mu": np.nan}, "mu = nan"),
        ({"mu": -0.1}, "not negative"),
        ({"part.M": 0.0}, "inertia 0"),
        ({"part.K": -1.0}, "not negative"),
    ):
        with pytest.raises(ValueError, match=message):
            model.matrices(values)
    divided = MatrixModel("v", {"M": M, "K": K, "D_per_v": K}, {"speed": 1.0})
    with pytest.raises(ValueError, match="speed = 0: the matrix D_per_v is divided"):
        divided.matrices({"speed": 0.0})


def test_names_of_freedoms() -> None:
    for names in (["a"], ["a", "a"]):
        with pytest.raises(ValueError, match="names of freedoms"):
            MatrixModel("m", {"M": M, "K": K}, {}, names)


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("x.npz", b"no zip", "npz"),
        ("x.mat", b"MATLAB" * 30, "not a MATLAB file"),
        ("x.csv", b"1,2", r"\.npz or \.mat"),
    ],
)
def test_damaged_files(tmp_path: Path, name: str, content: bytes, message: str) -> None:
    (tmp_path / name).write_bytes(content)
    with pytest.raises(ValueError, match=message):
        load_matrices(tmp_path / name)


def test_hdf5_mat_says_how_to_save(tmp_path: Path) -> None:
    header = b"MATLAB 7.3 MAT-file".ljust(124, b" ") + b"\x00\x02IM"
    (tmp_path / "new.mat").write_bytes(header + bytes(512))
    with pytest.raises(ValueError, match="-v7"):
        load_matrices(tmp_path / "new.mat")


def test_damaged_folders(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"no \.mtx files"):
        load_matrices(tmp_path)
    (tmp_path / "M.mtx").write_text("1 1 3.0\n2 2 1.0\n")  # Abaqus' rows without a header
    with pytest.raises(ValueError, match=r"M\.mtx: not a Matrix Market file"):
        load_matrices(tmp_path)
    io.mmwrite(tmp_path / "M.mtx", M)
    io.mmwrite(tmp_path / "K.mtx", K)
    (tmp_path / "model.toml").write_text("quantites = 1")
    with pytest.raises(ValueError, match="unknown key 'quantites'"):
        load_matrices(tmp_path)
    (tmp_path / "model.toml").write_text('[[groups]]\nname = "g"\nboth = ["part.Q"]')
    with pytest.raises(ValueError, match=r"group 'g'.*part.Q"):
        load_matrices(tmp_path)
    (tmp_path / "model.toml").unlink()
    io.mmwrite(tmp_path / "stiff.mtx", K)
    with pytest.raises(ValueError, match="no matrix is called 'stiff'"):
        load_matrices(tmp_path)


def test_pickles_are_not_read(tmp_path: Path) -> None:
    np.savez(tmp_path / "p.npz", M=np.array([sparse.csr_array(M)], dtype=object), K=K)
    with pytest.raises(ValueError, match="save_matrices"):
        load_matrices(tmp_path / "p.npz")
