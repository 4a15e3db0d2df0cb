using System;
using System.Collections.Generic;
using Kinefab.Document;
using Kinefab.Numerics;
using Kinefab.Validation;

namespace Kinefab.Collisions;

/// <summary>A collider where it stands in the world: convex, or the surface of a mesh.</summary>
internal sealed class StandingCollider
{
    private readonly Vector3d[]? _corners;

    private StandingCollider(int owner, ConvexShape hull, Vector3d[]? corners)
    {
        Owner = owner;
        Hull = hull;
        _corners = corners;
    }

    /// <summary>Index of the GameObject that carries it.</summary>
    public int Owner { get; }

    /// <summary>The collider itself, or the hull of a mesh of which only the surface counts.</summary>
    public ConvexShape Hull { get; }

    /// <summary>Whether all inside of <see cref="Hull"/> counts.</summary>
    public bool IsSolid => _corners is null;

    /// <summary>Triangles of a surface; 0 of a solid.</summary>
    public int Triangles => _corners is null ? 0 : _corners.Length / 3;

    /// <summary>A triangle of a surface.</summary>
    public ConvexShape Triangle(int index) => new(new[] { _corners![3 * index], _corners[3 * index + 1], _corners[3 * index + 2] }, 0);

    /// <summary>All that can touch anything, in the order of the objects and their components.</summary>
    public static List<StandingCollider> Of(ValidScene scene)
    {
        var found = new List<StandingCollider>();
        IReadOnlyList<GameObject> objects = scene.Document.GameObjects;
        for (int i = 0; i < objects.Count; i++)
        {
            if (!scene.IsActive(i))
                continue;
            foreach (Component component in objects[i].Components)
            {
                if (component is Collider { Enabled: true, IsTrigger: false } collider && Standing(scene, i, collider) is StandingCollider standing)
                    found.Add(standing);
            }
        }

        return found;
    }

    // Null of a shape without extent.
    private static StandingCollider? Standing(ValidScene scene, int owner, Collider collider)
    {
        WorldTransform at = scene.WorldTransform(owner);
        Vector3d scale = at.Scale;
        switch (collider)
        {
            case BoxCollider box when Largest(box.Size) > 0:
                var corners = new Vector3d[8];
                for (int i = 0; i < corners.Length; i++)
                {
                    var sign = new Vector3d((i & 1) - 0.5, ((i >> 1) & 1) - 0.5, (i >> 2) - 0.5);
                    corners[i] = at.Point(box.Center + Vector3d.Scale(box.Size, sign));
                }

                return new StandingCollider(owner, new ConvexShape(corners, 0), null);
            case SphereCollider sphere when sphere.Radius > 0:
                return new StandingCollider(owner, new ConvexShape(new[] { at.Point(sphere.Center) }, sphere.Radius * Largest(scale)), null);
            case CapsuleCollider capsule when capsule.Radius > 0:
                // Unity scales the height along the capsule and the radius by the larger of the other two.
                int axis = (int)capsule.Direction;
                double radius = capsule.Radius * Math.Max(Math.Abs(scale[(axis + 1) % 3]), Math.Abs(scale[(axis + 2) % 3]));
                double half = Math.Max(0, Math.Abs(scale[axis]) * capsule.Height / 2 - radius);
                Vector3d along = at.Pose.Rotation * (axis == 0 ? Vector3d.UnitX : axis == 1 ? Vector3d.UnitY : Vector3d.UnitZ);
                Vector3d centre = at.Point(capsule.Center);
                return new StandingCollider(owner, new ConvexShape(new[] { centre - half * along, centre + half * along }, radius), null);
            case MeshCollider mesh:
                return OfMesh(scene, owner, mesh);
            default:
                return null;
        }
    }

    private static StandingCollider? OfMesh(ValidScene scene, int owner, MeshCollider collider)
    {
        WorldTransform at = scene.WorldTransform(owner);
        MeshData mesh = scene.Mesh(collider.Mesh);
        ReadOnlySpan<float> numbers = mesh.Positions;
        if (numbers.Length < 3)
            return null;
        var points = new Vector3d[numbers.Length / 3];
        for (int i = 0; i < points.Length; i++)
            points[i] = at.Point(new Vector3d(numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]));
        var hull = new ConvexShape(points, 0);
        if (collider.Convex)
            return new StandingCollider(owner, hull, null);
        int count = Math.Max(mesh.Indices16.Length, mesh.Indices32.Length);
        var corners = new Vector3d[count - count % 3];
        for (int i = 0; i < corners.Length; i++)
            corners[i] = points[mesh.Indices16.Length > 0 ? mesh.Indices16[i] : (int)mesh.Indices32[i]];
        return new StandingCollider(owner, hull, corners);
    }

    private static double Largest(Vector3d size) => Math.Max(Math.Abs(size.X), Math.Max(Math.Abs(size.Y), Math.Abs(size.Z)));
}
