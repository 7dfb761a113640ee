import numpy as np
import pytest
import snug

BOX = "<link name='{0}'><collision><origin xyz='0.5 0 0'/><geometry><box size='0.9 {1} {1}'/></geometry></collision></link>"
JOINT = (
    "<joint name='{0}' type='revolute'><parent link='{1}'/><child link='{2}'/><origin xyz='1 0 0'/><axis xyz='0 0 1'/>"
    "<limit lower='-3.2' upper='3.2'/></joint>"
)


@pytest.fixture
def arm(tmp_path):
    links = "".join(BOX.format(*link) for link in (("base", 0.2), ("upper", 0.2), ("lower", 0.15)))
    joints = JOINT.format("shoulder", "base", "upper") + JOINT.format("elbow", "upper", "lower")
    (tmp_path / "arm.urdf").write_text(f"<robot name='arm'>{links}{joints}</robot>")
    return snug.urdf(tmp_path / "arm.urdf")


def test_a_robot_has_links_and_joints(arm):
    assert arm.name == "arm" and arm.links == ["base", "upper", "lower"] and arm.outward == 0
    assert arm.joints == {"shoulder": (-3.2, 3.2), "elbow": (-3.2, 3.2)}
    assert repr(arm) == "<snug.Robot arm: 3 links>"
    poses = arm.poses({"shoulder": np.pi / 2})
    assert np.allclose(poses["lower"][:3, 3], [1, 1, 0]) and poses["lower"].shape == (4, 4)


def test_first_contacts_are_proved_between_the_positions(arm):
    fold = [{}, {"shoulder": 1.2, "elbow": 1.2}, {"shoulder": 2.4, "elbow": 2.4}]
    ((a, b, first),) = arm.first_contacts(fold)
    assert (a, b, first.verdict) == ("base", "lower", "intersecting")
    assert 1 < first.time[0] <= first.time[1] < 2
    ((_, _, straight),) = arm.first_contacts(fold[:2])
    assert straight.verdict == "separated"
    assert len(arm.first_contacts(fold[:1], joined=True)) == 3


def test_a_margin_is_kept_along_the_whole_path(arm):
    fold = [{}, {"shoulder": 1.2, "elbow": 1.2}, {"shoulder": 2.4, "elbow": 2.4}]
    ((_, _, touch),) = arm.first_contacts(fold, tolerance=1e-4)
    ((_, _, near),) = arm.first_contacts(fold, tolerance=1e-4, margin=0.05)
    ((_, _, percent),) = arm.first_contacts(fold, tolerance=1e-4, margin="10%")
    assert near.verdict == "within" and near.upper < touch.lower
    assert percent.upper < near.upper, "of a link of length 0.9"
    assert arm.first_contacts(fold[:2], margin=0.05)[0][2].verdict == "separated"
    with pytest.raises(ValueError, match="margin"):
        arm.first_contacts(fold, margin=-1)


def test_link_motions_are_what_clearance_takes(arm, tmp_path):
    path = [{}, {"shoulder": 0.4, "elbow": 1.2}]
    base, still, lower, moving = arm.link_motions("base", "lower", path)
    room = snug.clearance(base, still, lower, moving, relative=1e-3)
    nearest = np.inf
    for time in np.linspace(0, 1, 21):
        link = arm.poses({"shoulder": 0.4 * time, "elbow": 1.2 * time})["lower"]
        corners = lower.vertices @ moving.at(time)[:3, :3].T + moving.at(time)[:3, 3]
        in_link = (corners - link[:3, 3]) @ link[:3, :3]
        assert np.allclose(np.abs(in_link - [0.5, 0, 0]), [0.45, 0.075, 0.075]), "the box of the file"
        gaps = np.maximum(np.abs(corners - [0.5, 0, 0]) - [0.45, 0.1, 0.1], 0)
        nearest = min(nearest, np.linalg.norm(gaps, axis=1).min())
    assert 0 < room.lower <= nearest and np.allclose(still.at(0.7), arm.poses()["base"] @ still.at(0))
    for wrong in ("hand", "lower#1"):
        with pytest.raises(ValueError, match=f"no link is called '{wrong}'"):
            arm.link_motions("base", wrong, path)
    twice = (tmp_path / "arm.urdf").read_text().replace("</collision>", "</collision><collision><geometry><box size='1 1 1'/></geometry></collision>", 1)
    (tmp_path / "twice.urdf").write_text(twice.replace("</robot>", "<link name='bare'/>" + JOINT.format("j", "base", "bare") + "</robot>"))
    double = snug.urdf(tmp_path / "twice.urdf")
    assert double.link_motions("base#2", "lower", path)[0].size == 1
    with pytest.raises(ValueError, match="'base' has several shapes: give 'base#1' to 'base#2'"):
        double.link_motions("base", "lower", path)
    with pytest.raises(ValueError, match="'bare' has no shape"):
        double.link_motions("bare", "lower", path)


def test_groups_restrict_what_is_asked(arm, tmp_path):
    (tmp_path / "arm.srdf").write_text("<robot><group name='wrist'><link name='lower'/></group></robot>")
    grouped = snug.urdf(tmp_path / "arm.urdf", srdf=tmp_path / "arm.srdf")
    pairs = [(a, b) for a, b, _ in grouped.first_contacts([{}], joined=True, group="wrist")]
    assert pairs == [("base", "lower"), ("upper", "lower")]
    with pytest.raises(ValueError, match="no group 'arm'"):
        grouped.first_contacts([{}], group="arm")


def test_wrong_robots_and_positions_are_told(arm, tmp_path):
    with pytest.raises(ValueError, match="no joint is called 'knee'"):
        arm.poses({"knee": 1})
    with pytest.raises(ValueError, match="beyond its limits"):
        arm.first_contacts([{"elbow": 4}])
    with pytest.raises(ValueError, match="give positions of the joints"):
        arm.first_contacts([])
    with pytest.raises(TypeError):
        snug.Robot()
    (tmp_path / "cycle.urdf").write_text(
        f"<robot>{BOX.format('a', 1)}{BOX.format('b', 1)}{JOINT.format('j', 'a', 'b')}{JOINT.format('k', 'b', 'a')}</robot>"
    )
    with pytest.raises(snug.FileError, match="in a cycle: 'a', 'b'"):
        snug.urdf(tmp_path / "cycle.urdf")
    with pytest.raises(snug.FileError):
        snug.urdf(tmp_path / "none.urdf")


def test_parts_of_a_file_are_where_it_places_them(tmp_path):
    box = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"
    (tmp_path / "one.obj").write_text(box)
    ((name, alone, pose),) = snug.read_assembly(tmp_path / "one.obj", scheme="bilinear")
    assert (name, alone.scheme) == ("one", "bilinear") and np.array_equal(pose, np.eye(4))
    mesh = """
    def Mesh "{0}" {{
        int[] faceVertexCounts = [4]
        int[] faceVertexIndices = [0, 1, 2, 3]
        point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
        double3 xformOp:translate = ({1}, 0, 0)
        uniform token[] xformOpOrder = ["xformOp:translate"]
    }}
    """
    (tmp_path / "two.usda").write_text("#usda 1.0\n" + mesh.format("left", 0) + mesh.format("right", 3))
    parts = snug.read_assembly(tmp_path / "two.usda", scheme="bilinear")
    assert [name for name, _, _ in parts] == ["left", "right"]
    manager = snug.CollisionManager()
    for name, surface, pose in parts:
        manager.add_object(name, surface, pose)
    assert manager.min_distance_internal() == pytest.approx(2)
    assert parts[1][2][0, 3] == 3
    with pytest.raises(snug.FileError):
        snug.read_assembly(tmp_path / "none.usda")
