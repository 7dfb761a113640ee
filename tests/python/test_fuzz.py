"""Whatever Python can pass, there is an answer or an exception of Python: the interpreter lives on, and numbers stay sound.

SNUG_FUZZ=N runs N cases of each.
"""

import contextlib
import pathlib
import tempfile

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

import snug
from conftest import CUBE, CUBE_FACES, moved

EXPECTED = (ValueError, TypeError, OverflowError, MemoryError, snug.FileError, snug.UndecidedError)

numbers = st.one_of(
    st.floats(-2, 2),
    st.floats(width=64),
    st.sampled_from([0.0, -0.0, 1.0, -1.0, 5e-324, 1e-300, 1e300, -1.7e308, np.inf, np.nan]),
)
dtypes = st.one_of(
    arrays.floating_dtypes(),
    arrays.integer_dtypes(),
    arrays.unsigned_integer_dtypes(),
    arrays.boolean_dtypes(),
    arrays.complex_number_dtypes(),
    arrays.unicode_string_dtypes(max_len=3),
    arrays.datetime64_dtypes(),
)
shapes = arrays.array_shapes(min_dims=0, max_dims=4, min_side=0, max_side=5)
anything = st.one_of(
    dtypes.flatmap(lambda dtype: arrays.arrays(dtype, shapes)),
    st.sampled_from([(3,), (7, 3), (4, 4), (3, 4), (2, 4, 4), (2, 3, 4), (3, 3), (4,), (2, 4)]).flatmap(
        lambda shape: arrays.arrays(np.float64, shape, elements=numbers)
    ),
    st.recursive(st.one_of(st.none(), st.booleans(), st.integers(), numbers, st.text(max_size=3), st.binary(max_size=3)),
                 lambda inner: st.one_of(st.lists(inner, max_size=4), st.tuples(inner, inner)), max_leaves=12),
)


def seen(answer):
    """Looks at all properties, which makes their arrays."""
    for name in dir(type(answer)):
        if not name.startswith("_") and isinstance(getattr(type(answer), name), property):
            try:
                getattr(answer, name)
            except EXPECTED:
                pass
    repr(answer)
    return answer


def attempt(work):
    try:
        return seen(work())
    except EXPECTED:
        return None


SOLID = snug.Surface(CUBE, CUBE_FACES)


@given(anything)
def test_points(given_points):
    near = attempt(lambda: SOLID.closest_point(given_points, max_splits=100))
    attempt(lambda: SOLID.signed_distance(given_points, max_splits=100))
    attempt(lambda: SOLID.contains(given_points))
    if near is not None:
        assert not np.isnan(near.lower).any() and (np.asarray(near.lower) <= near.upper).all()


@given(anything, anything)
def test_poses(a, b):
    for rigid in (None, "nearest"):
        hit = attempt(lambda: snug.collide(SOLID, SOLID, pose_a=a, pose_b=b, rigid=rigid, max_splits=100))
        attempt(lambda: snug.distance(SOLID, SOLID, pose_a=a, pose_b=(a, b), rigid=rigid, max_splits=100))
        if hit is not None:
            assert (np.asarray(hit.lower) <= hit.upper).all()


@given(anything, anything, anything)
def test_motions(a, b, c):
    path = attempt(lambda: snug.Trajectory.steady(a, velocity=b, radians=0.5, about=c))
    for motion in (a, path):
        first = attempt(lambda: snug.time_of_contact(SOLID, None, SOLID, motion, max_splits=2000))
        if first is not None:
            assert first.lower <= first.upper
        room = attempt(lambda: snug.clearance(SOLID, None, SOLID, motion, relative=0.3, max_splits=2000))
        if room is not None:
            assert room.lower <= room.upper and (room.spans.lower <= room.spans.upper).all()


names = st.one_of(anything, st.sampled_from(["a", "b", "c"]))


@given(names, names, anything)
def test_managers(a, b, pose):
    manager = snug.CollisionManager(tolerance=0.1, depth=False)
    for name in (a, b):
        attempt(lambda: manager.add_object(name, SOLID, pose, group=b))
        attempt(lambda: manager.allow(a, name))
    attempt(lambda: manager.in_collision_internal(return_names=True, return_data=True))
    attempt(lambda: manager.min_distance_internal(a))
    other = snug.CollisionManager(tolerance=pose, relative=a, rigid=b, scheme=pose, sharp=a)
    attempt(lambda: other.add_object("one", (CUBE, CUBE_FACES), moved(3)))
    attempt(lambda: manager.set_transform(a, pose))
    for mesh in (SOLID, a):
        attempt(lambda: manager.in_collision_single(mesh, pose, return_data=True))
        attempt(lambda: manager.min_distance_single(mesh, pose, return_data=True))
    attempt(lambda: manager.in_collision_other(other, return_names=True))
    attempt(lambda: manager.min_distance_other(other, return_names=True))
    attempt(lambda: manager.is_allowed(a, b))
    attempt(lambda: manager.remove_object(a))
    attempt(lambda: snug.collision.scene_to_collision(pose, scheme=a, sharp=b))


@given(anything, anything, st.sampled_from(["max_sphere", "ray", ""]))
def test_proximity(points, directions, method):
    of = snug.proximity
    for ask in (of.closest_point, of.closest_point_naive, of.nearby_faces, of.signed_distance, of.reach):
        attempt(lambda: ask(SOLID, points))
    attempt(lambda: of.closest_point(directions, points, scheme=points, sharp=method))
    attempt(lambda: of.longest_ray(SOLID, points, directions))
    attempt(lambda: of.max_tangent_sphere(SOLID, points, normals=directions, threshold=1e-2, max_iter=3))
    attempt(lambda: of.thickness(SOLID, points, directions, normals=directions, method=method))
    query = of.ProximityQuery(SOLID)
    for ask in (query.on_surface, query.vertex, query.signed_distance):
        attempt(lambda: ask(points))


MANY = snug.collide(SOLID, SOLID, pose_b=[moved(1), moved(3)]), SOLID.closest_point(CUBE), SOLID.bound(level=1)


@given(anything, anything, st.one_of(st.integers(-3, 3), st.slices(4), anything))
def test_paths_and_places(poses, time, which):
    path = attempt(lambda: snug.Trajectory.through(poses)) or snug.Trajectory.through([moved(3), moved()])
    attempt(lambda: path.at(time))
    attempt(lambda: snug.Trajectory.through(poses, rigid=time))
    attempt(lambda: snug.view(SOLID, poses=poses, template=time))
    deep = attempt(lambda: snug.penetration(SOLID, SOLID, pose_b=poses, relative=time, max_splits=50))
    if deep is not None:
        assert (np.asarray(deep.lower) <= deep.upper).all()
    for many in MANY:
        with contextlib.suppress(IndexError):
            attempt(lambda: many[which])
            attempt(lambda: MANY[0][which].any())
            attempt(lambda: MANY[0][which].all())


@given(st.one_of(st.binary(max_size=64), st.text(max_size=64)), st.sampled_from([".obj", ".off", ".ply", ".stl", ".usda", ".glb", ".gltf", ".3mf", ""]), anything)
def test_files(content, ending, option):
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / f"mesh{ending}"
        file.write_bytes(content if isinstance(content, bytes) else content.encode(errors="surrogatepass"))
        attempt(lambda: snug.read(file))
        attempt(lambda: snug.read_assembly(file))
        attempt(lambda: snug.read(option, scheme=option, sharp=content))
        attempt(lambda: SOLID.write(file))
        attempt(lambda: SOLID.subdivided(1).write(file))
        attempt(lambda: snug.read(file).measure(relative=0.1, max_splits=100))
        attempt(lambda: SOLID.write_step(file, error=option))
        attempt(lambda: SOLID.write_step(file, error="5%", name=content, max_splits=100))


@given(anything, anything, anything, anything)
def test_contacts_and_meshes(pose, within, error, mesh):
    attempt(lambda: snug.contacts(SOLID, SOLID, pose_b=pose, within=within, error=error, max_splits=100))
    attempt(lambda: snug.inspect(mesh, CUBE_FACES))
    attempt(lambda: snug.inspect(CUBE, mesh))
    attempt(lambda: SOLID.envelope(error, clearance=within, gap=mesh, max_splits=100))
    attempt(lambda: SOLID.topology_of(within, error))
    attempt(lambda: SOLID.boxes(error, end=mesh, threads=1))
    attempt(lambda: SOLID.subdivided(within, limit=error))
    attempt(lambda: SOLID.limit_to_faces(threads=mesh))
    attempt(lambda: SOLID.measure(relative=error, max_splits=within))


LINK = "<link name='{0}'><collision><origin xyz='0.5 0 0'/><geometry><box size='0.9 0.2 0.2'/></geometry></collision></link>"
JOINT = (
    "<joint name='{0}' type='continuous'><parent link='{1}'/><child link='{2}'/><origin xyz='1 0 0'/><axis xyz='0 0 1'/></joint>"
)
ARM_TEXT = "<robot name='arm'>" + "".join(map(LINK.format, "abc")) + JOINT.format("x", "a", "b") + JOINT.format("y", "b", "c") + "</robot>"
positions = st.one_of(anything, st.dictionaries(st.sampled_from(["x", "y", "z"]), st.one_of(numbers, anything), max_size=3))


@given(positions, st.one_of(anything, st.lists(positions, max_size=3)), anything, anything)
def test_robots(at, path, tolerance, joined):
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "arm.urdf"
        file.write_text(ARM_TEXT)
        arm = snug.urdf(file)
        attempt(lambda: snug.urdf(file, packages=at, root=path, primitive_error=tolerance, visual=joined))
        attempt(lambda: snug.read_assembly(at, scheme=path, weld=tolerance, threads=joined))
    attempt(lambda: arm.poses(at))
    attempt(lambda: arm.link_motions(at, path, [{}, at]))
    attempt(lambda: snug.clearance(*arm.link_motions("a", "b", path), max_splits=100))
    for _, _, first in attempt(lambda: arm.first_contacts(path, tolerance=tolerance, joined=joined, max_splits=100)) or ():
        assert first.lower <= seen(first).upper
    for _, _, first in attempt(lambda: arm.first_contacts([{}, at], max_splits=100, threads=joined)) or ():
        assert first.lower <= first.upper


@given(anything, anything, st.sampled_from(["nearest", "any", "all"]), st.booleans())
def test_rays(origins, directions, query, certified):
    attempt(lambda: SOLID.ray(origins, directions, query=query, certified=certified, max_splits=100))


@given(anything, anything, anything, anything)
def test_parameters(face, u, v, corner):
    attempt(lambda: SOLID.evaluate(face, u, v, corner))


@given(anything, st.one_of(anything, st.lists(st.lists(st.integers(0, 8), max_size=5), max_size=8)), anything, anything, anything)
def test_meshes(vertices, faces, creases, corners, holes):
    for work in (
        lambda: snug.Surface(vertices, faces),
        lambda: snug.Surface(CUBE, faces),
        lambda: snug.Surface(vertices, CUBE_FACES),
        lambda: snug.Surface(CUBE, CUBE_FACES, creases=creases),
        lambda: snug.Surface(CUBE, CUBE_FACES, corners=corners),
        lambda: snug.Surface(CUBE, CUBE_FACES, holes=holes),
    ):
        made = attempt(work)
        if made is not None:
            attempt(lambda: made.measure(max_splits=100))
            attempt(lambda: made.bound(level=1))
            attempt(lambda: snug.collide(made, SOLID, max_splits=100))


@given(
    st.lists(st.lists(st.integers(0, 7), min_size=3, max_size=5), min_size=1, max_size=8),
    arrays.arrays(np.float64, (8, 3), elements=numbers),
    st.sampled_from(["auto", "loop", "catmark", "doo-sabin", "midedge", "bilinear", "flat"]),
    st.sampled_from([None, 0, 30, "auto", 200]),
    st.sampled_from([None, True, 0.5]),
)
def test_random_meshes(faces, vertices, scheme, sharp, weld):
    made = attempt(lambda: snug.Surface(vertices, faces, scheme=scheme, sharp=sharp, weld=weld))
    if made is None:
        return
    attempt(lambda: made.boxes())
    attempt(lambda: made.subdivided(1, limit=True))
    attempt(lambda: made.tessellate("20%", max_splits=1000))
    attempt(lambda: made.update(vertices[::-1]))
    near = attempt(lambda: made.closest_point([0.5, 0.25, 0.125], max_splits=200))
    if near is not None:
        assert near.lower <= near.upper


@given(anything, anything, anything)
def test_options(a, b, c):
    attempt(lambda: snug.collide(SOLID, SOLID, pose_b=moved(3), tolerance=a, margin=b, max_splits=c))
    attempt(lambda: snug.collide(SOLID, SOLID, pose_b=[moved(3)], threads=a, witness=b, rigid=c))
    attempt(lambda: snug.distance(SOLID, SOLID, pose_b=moved(3), relative=a, absolute=b, max_splits=500))
    attempt(lambda: SOLID.bound(error=a, level=2, max_splits=100))
    attempt(lambda: SOLID.bound(level=a, max_splits=100))
    attempt(lambda: SOLID.tessellate(a, max_edge=b, view=(b, c), max_triangles=c, max_splits=1000))
    attempt(lambda: SOLID.hull(a, max_splits=100))
    attempt(lambda: snug.deviation(SOLID, a, max_splits=100))
    attempt(lambda: SOLID.self_contact(within=a, radius=b, levels=c, max_splits=100))
    attempt(lambda: snug.time_of_contact(SOLID, None, SOLID, [moved(3), moved()], tolerance=a, margin=b, max_splits=2000))
    attempt(lambda: snug.clearance(SOLID, None, SOLID, [moved(3), moved()], absolute=a, relative=b, max_splits=2000))
    attempt(lambda: SOLID.update(a))
    attempt(lambda: snug.Surface(CUBE, CUBE_FACES, scheme=a, boundary=b, crease_method=c))
    attempt(lambda: snug.Surface(CUBE, CUBE_FACES, sharp=a, weld=b, smooth_triangles=c))
    attempt(lambda: SOLID.update(CUBE))


@given(st.binary(max_size=64), st.integers(0, 10**6), st.booleans())
def test_pickles(content, size, single):
    for cls in (snug.Collision, snug.Distance, snug.ClosestPoint):
        for count in (size, len(snug.collide(SOLID, SOLID, pose_b=[moved(3)]).__getstate__()[3])):
            attempt(lambda: cls.__new__(cls).__setstate__((snug.__version__, count, single, content)))


def test_every_public_function_is_tried():
    text = pathlib.Path(__file__).read_text()
    owners = [snug, snug.collision, snug.proximity, *(getattr(snug, name) for name in snug.__all__), snug.proximity.ProximityQuery]
    functions = {
        name
        for owner in owners
        if owner in (snug, snug.collision, snug.proximity) or (isinstance(owner, type) and not issubclass(owner, (Exception, Warning)))
        for name in getattr(owner, "__all__", dir(owner))
        if not name.startswith("_") and callable(getattr(owner, name)) and not isinstance(getattr(owner, name), type)
    }
    assert len(functions) > 50
    assert [name for name in sorted(functions) if f".{name}(" not in text and f".{name}," not in text and f".{name})" not in text] == []
