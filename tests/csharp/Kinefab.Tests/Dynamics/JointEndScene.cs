using System.Collections.Generic;
using Kinefab.Document;
using Kinefab.Numerics;
using Kinefab.Validation;

namespace Kinefab.Tests.Dynamics;

/// <summary>
/// One scene with every kind of joint end, which kinematics and dynamics must read alike: inactive bodies by themselves and
/// under an inactive object, nested bodies, bodies under plain objects, kinematic bodies on either side.
/// </summary>
internal static class JointEndScene
{
    /// <summary>The bodies' objects, in order.</summary>
    public static readonly string[] Bodies = ["arm", "nested", "deep", "hung", "hungBelow", "carried", "kinematic", "onKinematic"];

    /// <summary>Own and connected body of every joint, in order of the objects; a joint of an inactive object is none.</summary>
    public static readonly string[] Ends =
    [
        "arm-world",
        "nested-arm",
        "deep-nested",
        "hung-world", // its connected body is inactive, and the arm carries that object along
        "hungBelow-world", // its connected body stands under an inactive object
        "kinematic-carried",
        "onKinematic-kinematic",
    ];

    public static ValidScene Make()
    {
        var objects = new List<GameObject>();
        Add("base", null, Vector3d.UnitY);
        Add("arm", "base", Vector3d.UnitX, Body(), Hinge());
        Add("nested", "arm", new Vector3d(0.5, 0.1, 0), Body(), Hinge("arm"));
        Add("plate", "nested", new Vector3d(0, 0.2, 0));
        Add("deep", "plate", new Vector3d(0.3, 0, 0), Body(), Hinge("nested"));
        Add("off", "arm", new Vector3d(0.2, 0, 0), Body());
        Add("below", "off", new Vector3d(0.1, 0, 0), Body());
        Add("hung", null, new Vector3d(0.4, 0.3, 0), Body(), Hinge("off"));
        Add("hungBelow", null, new Vector3d(0.1, -0.4, 0), Body(), Hinge("below"));
        Add("carried", null, new Vector3d(2, 1, 0), Body());
        Add("kinematic", null, new Vector3d(2, 0, 0), Body(isKinematic: true), Hinge("carried"));
        Add("onKinematic", null, new Vector3d(2.5, 0, 0), Body(), Hinge("kinematic"));
        Add("gone", "arm", new Vector3d(0, 0.7, 0), Body(), Hinge("arm"));
        var coupling = new Coupling
        {
            A = new JointCoordinate { GameObject = Index("arm"), Component = 1, Coordinate = Coordinate.Angle },
            B = new JointCoordinate { GameObject = Index("gone"), Component = 1, Coordinate = Coordinate.Angle },
            Ratio = 2,
        };
        return SmallScene.Validate(new SceneDocument { GameObjects = objects, Couplings = [coupling] });

        int Index(string id) => objects.FindIndex(o => o.Id == id);

        Rigidbody Body(bool isKinematic = false) => new() { AngularDamping = 0, IsKinematic = isKinematic };

        // Anchors lie beside the centre of mass, so that gravity turns every body.
        HingeJoint Hinge(string? connected = null) =>
            new() { Axis = Vector3d.UnitZ, Anchor = new Vector3d(-0.3, 0.05, 0), ConnectedBody = connected is null ? null : Index(connected) };

        void Add(string id, string? parent, Vector3d position, params Component[] components) => objects.Add(new GameObject
        {
            Id = id,
            Name = id,
            Parent = parent is null ? null : Index(parent),
            Active = id is not ("off" or "gone"),
            Transform = new Transform { LocalPosition = position, LocalRotation = Quaterniond.AxisAngle(Vector3d.UnitZ, 0.2 + 0.1 * objects.Count) },
            Components = components,
        });
    }
}
