using System.Collections.Generic;
using Kinefab.Document;
using Kinefab.Numerics;

namespace Kinefab.Bench;

/// <summary>Bodies at the origin, so that anchors are world points.</summary>
internal sealed class PlanarScene
{
    private readonly List<List<Component>> bodies = [];
    private readonly List<Coupling> couplings = [];

    internal int Body()
    {
        bodies.Add([new Rigidbody()]);
        return bodies.Count - 1;
    }

    internal void Hinge(int own, int? connected, Vector3d point, bool closure = false) =>
        Add(own, new HingeJoint { ConnectedBody = connected, Anchor = point, Axis = Vector3d.UnitZ, Closure = closure });

    internal void Add(int own, Component joint) => bodies[own].Add(joint);

    /// <summary>Ties the first hinge of one body to that of another.</summary>
    internal void Gear(int a, int b, double ratio) => couplings.Add(new Coupling { A = FirstHinge(a), B = FirstHinge(b), Ratio = ratio });

    internal SceneDocument Document()
    {
        var objects = new List<GameObject>();
        for (int i = 0; i < bodies.Count; i++)
            objects.Add(new GameObject { Id = $"b{i}", Name = $"b{i}", Components = bodies[i].ToArray() });
        return new SceneDocument { GameObjects = objects, Couplings = couplings };
    }

    private static JointCoordinate FirstHinge(int body) => new() { GameObject = body, Component = 1, Coordinate = Coordinate.Angle };
}
