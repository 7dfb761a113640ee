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


def test_wrong_robots_and_positions_are_told(arm, tmp_path):
    with pytest.raises(ValueError, match="no joint is called 'knee'"):
        arm.poses({"knee": 1})
    with pytest.raises(ValueError, match="beyond its limits"):
        arm.first_contacts([{"elbow": 4}])
    with pytest.raises(ValueError, match="give a dict of positions"):
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
