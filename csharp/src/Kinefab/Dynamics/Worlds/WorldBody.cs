using System.Diagnostics;
using System;
using Kinefab.Document;
using Kinefab.Numerics;
using Kinefab.Validation;

namespace Kinefab.Dynamics;

/// <summary>A Rigidbody, or an ArticulationBody, in a <see cref="World"/>.</summary>
[DebuggerDisplay("{ToString(),nq}")]
public sealed class WorldBody
{
    private readonly MultibodySystem _system;
    private readonly Bodies _bodies;
    private readonly ValidScene _scene;
    private readonly int _index;
    private readonly Pose _local;
    private readonly Pose _localInverse;
    private Rigidbody _settings;

    internal WorldBody(MultibodySystem system, int index, int gameObject, ValidScene scene, Rigidbody settings)
    {
        _system = system;
        _bodies = system.Bodies;
        _index = index;
        _scene = scene;
        _local = RigidbodyModel.MassFrame(settings);
        _localInverse = _local.Inverse();
        _settings = settings;
        GameObject = gameObject;
        Id = scene.Document.GameObjects[gameObject].Id;
        Name = scene.Document.GameObjects[gameObject].Name;
    }

    /// <summary>Of the root of an articulation its other links, which go where it is put.</summary>
    internal int[] LinksBelow { get; set; } = Array.Empty<int>();

    /// <summary>Index of the GameObject that carries the Rigidbody.</summary>
    public int GameObject { get; }

    /// <summary>Id of the GameObject.</summary>
    public string Id { get; }

    /// <summary>Name of the GameObject.</summary>
    public string Name { get; }

    /// <summary>
    /// Mass, inertiaTensor, dampings, useGravity, maxAngularVelocity and iterations; at first as the scene has them. A new value acts from the
    /// next step on; the centre of mass, the tensor's rotation, the constraints and isKinematic stay as created.
    /// </summary>
    /// <exception cref="ArgumentException">A field that is decided at creation differs, or a number is out of its range or none; the message names it.</exception>
    /// <example><code>
    /// body.Settings = body.Settings with { Mass = 2.5 };
    /// </code></example>
    public Rigidbody Settings
    {
        get => _settings;
        set
        {
            if (value is null)
                throw new ArgumentNullException(nameof(value));
            if (value.CenterOfMass != _settings.CenterOfMass || value.InertiaTensorRotation != _settings.InertiaTensorRotation
                || value.Constraints != _settings.Constraints || value.IsKinematic != _settings.IsKinematic)
            {
                throw new ArgumentException("centerOfMass, inertiaTensorRotation, constraints and isKinematic are decided when the body is created.", nameof(value));
            }

            SettingsCheck.ThrowIfWrong(value);
            _settings = value;
            _bodies.Change(_index, RigidbodyModel.Of(value, _scene.Document.Physics, Kinefab.Numerics.Pose.Identity));
            _system.HasChangedBodies = true;
        }
    }

    /// <summary>
    /// Pose of the GameObject in the world. Setting it teleports the body and keeps its velocities; the rotation is normalised. With the root of an
    /// articulation all its links go, and keep their joints' speeds.
    /// </summary>
    /// <exception cref="ArgumentOutOfRangeException">A component is no number, or the rotation is zero.</exception>
    /// <exception cref="InvalidOperationException">It is set of a link that is no root.</exception>
    public Pose Pose
    {
        get => _bodies.Poses[_index] * _localInverse;
        set
        {
            ThrowIfFollowing("pose", "position");
            Pose pose = Checked(value) * _local;
            Pose way = pose * _bodies.Poses[_index].Inverse();
            _bodies.Poses[_index] = pose;
            _bodies.KinematicTargets[_index] = pose;
            if (LinksBelow.Length > 0)
                TakeAlong(way);
        }
    }

    /// <summary>Where a kinematic body is after the next step (Rigidbody.MovePosition and MoveRotation); the rotation is normalised.</summary>
    /// <exception cref="ArgumentOutOfRangeException">A component is no number, or the rotation is zero.</exception>
    /// <exception cref="InvalidOperationException">It is set of a link, which Unity does not move so.</exception>
    public Pose KinematicTarget
    {
        get => _bodies.KinematicTargets[_index] * _localInverse;
        set
        {
            if (IsLink)
                throw new InvalidOperationException("A link has no kinematic target: set the pose of its root.");
            _bodies.KinematicTargets[_index] = Checked(value) * _local;
        }
    }

    /// <summary>Centre of mass in the world, metres.</summary>
    public Vector3d CenterOfMass => _bodies.Poses[_index].Position;

    /// <summary>Velocity of the centre of mass, world frame, m/s. It can be set of the root of an articulation, not of its other links.</summary>
    /// <exception cref="ArgumentOutOfRangeException">A component is no number.</exception>
    /// <exception cref="InvalidOperationException">It is set of a link that is no root.</exception>
    public Vector3d LinearVelocity
    {
        get => _bodies.LinearVelocities[_index];
        set
        {
            ThrowIfFollowing("velocity", "speed");
            _bodies.LinearVelocities[_index] = value.FiniteOrThrow(nameof(value));
        }
    }

    /// <summary>World frame, rad/s. It can be set of the root of an articulation, not of its other links.</summary>
    /// <exception cref="ArgumentOutOfRangeException">A component is no number.</exception>
    /// <exception cref="InvalidOperationException">It is set of a link that is no root.</exception>
    public Vector3d AngularVelocity
    {
        get => _bodies.AngularVelocities[_index];
        set
        {
            ThrowIfFollowing("velocity", "speed");
            _bodies.AngularVelocities[_index] = value.FiniteOrThrow(nameof(value));
            _system.HasChangedSpeeds = true;
        }
    }

    /// <summary>Whether it is a link of an articulation (an ArticulationBody): its pose follows from its joints, but for a root's.</summary>
    public bool IsLink => _scene.Document.GameObjects[GameObject].Link is not null;

    /// <summary>Whether only its target moves the body.</summary>
    public bool IsKinematic => _bodies.IsKinematic[_index];

    /// <summary>Translation and rotation, J; 0 for a kinematic body.</summary>
    public double KineticEnergy => _bodies.KineticEnergy(_index);

    /// <summary>A force at the centre of mass over the next step, world frame, N.</summary>
    /// <param name="force">N, world frame; several add up.</param>
    /// <exception cref="ArgumentOutOfRangeException">A component is no number.</exception>
    public void AddForce(Vector3d force) => _bodies.Forces[_index] += force.FiniteOrThrow(nameof(force));

    /// <summary>A torque over the next step, world frame, N m.</summary>
    /// <param name="torque">N m, world frame, left-handed sense; several add up.</param>
    /// <exception cref="ArgumentOutOfRangeException">A component is no number.</exception>
    public void AddTorque(Vector3d torque) => _bodies.Torques[_index] += torque.FiniteOrThrow(nameof(torque));

    /// <summary>A force over the next step at a point of the world, N.</summary>
    /// <param name="force">N, world frame; several add up.</param>
    /// <param name="position">A point of the world, metres.</param>
    /// <exception cref="ArgumentOutOfRangeException">A component is no number.</exception>
    public void AddForceAtPosition(Vector3d force, Vector3d position)
    {
        Vector3d torque = Vector3d.Cross(position - CenterOfMass, force).FiniteOrThrow(nameof(position));
        AddForce(force);
        AddTorque(torque);
    }

    /// <summary>Where it is and how it moves, with units.</summary>
    public override string ToString() =>
        FormattableString.Invariant($"{Id}{(IsKinematic ? ", kinematic" : FormattableString.Invariant($", {_settings.Mass} kg"))} at {Pose}, {LinearVelocity} m/s, {AngularVelocity} rad/s");

    internal void Exchange(StateTape tape) => tape.Value(ref _settings);

    // A root's links keep their motion as seen from it: their joints' speeds.
    private void TakeAlong(in Pose way)
    {
        Vector3d v = _bodies.LinearVelocities[_index], w = _bodies.AngularVelocities[_index];
        Vector3d root = _bodies.Poses[_index].Position;
        Vector3d before = (way.Inverse() * _bodies.Poses[_index]).Position;
        foreach (int link in LinksBelow)
        {
            Vector3d own = _bodies.LinearVelocities[link] - v - Vector3d.Cross(w, _bodies.Poses[link].Position - before);
            Vector3d turning = _bodies.AngularVelocities[link] - w;
            _bodies.Poses[link] = way * _bodies.Poses[link];
            _bodies.LinearVelocities[link] = v + Vector3d.Cross(w, _bodies.Poses[link].Position - root) + way.Rotation * own;
            _bodies.AngularVelocities[link] = w + way.Rotation * turning;
        }

        _system.HasChangedSpeeds = true;
    }

    private void ThrowIfFollowing(string what, string ofJoint)
    {
        if (IsLink && !_scene.IsRootLink(GameObject))
            throw new InvalidOperationException($"A link's {what} follows from its joints: set its joint's {ofJoint}, or the root's {what}.");
    }

    private static Pose Checked(Pose value)
    {
        double square = value.Rotation.LengthSquared;
        return value.Position.IsFinite && square > 0 && square < double.PositiveInfinity
            ? new Pose(value.Position, value.Rotation.Normalized())
            : throw new ArgumentOutOfRangeException(nameof(value), "Not finite numbers, or a rotation of length 0.");
    }
}
