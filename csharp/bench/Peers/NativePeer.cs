using System;
using System.Runtime.InteropServices;
using Kinefab.Dynamics;
using Kinefab.Numerics;

namespace Kinefab.Bench.Peers;

/// <summary>An engine in C behind the few functions of native/peer.h.</summary>
internal sealed class NativePeer : IPeer
{
    private readonly IntPtr _world;
    private readonly Action<IntPtr, double> _step;
    private readonly Reader _read;
    private readonly Action<IntPtr> _destroy;

    /// <param name="library">Of <see cref="PeerList"/>.</param>
    /// <param name="scene">What moves.</param>
    /// <param name="substeps">Of each step.</param>
    /// <param name="frequency">Of the joints' springs, Hz; 0: the engine's own.</param>
    public NativePeer(IntPtr library, MultibodySystem scene, int substeps, double frequency)
    {
        _step = Function<Stepper>(library, "peer_step").Invoke;
        _read = Function<Reader>(library, "peer_read");
        _destroy = Function<Destroyer>(library, "peer_destroy").Invoke;
        Body body = Function<Body>(library, "peer_body");
        Hinge hinge = Function<Hinge>(library, "peer_hinge");
        _world = Function<Creator>(library, "peer_create")(substeps, frequency, new[] { scene.Gravity.X, scene.Gravity.Y, scene.Gravity.Z });
        Bodies bodies = scene.Bodies;
        for (int i = 0; i < bodies.Count; i++)
        {
            Vector3d inverse = bodies.InverseInertias[i];
            Vector3d v = bodies.LinearVelocities[i];
            Vector3d w = bodies.AngularVelocities[i];
            body(_world, Numbers(bodies.Poses[i]), 1 / bodies.InverseMasses[i], new[] { 1 / inverse.X, 1 / inverse.Y, 1 / inverse.Z }, new[] { v.X, v.Y, v.Z, w.X, w.Y, w.Z });
        }

        foreach (PeerJoint joint in PeerJoint.Of(scene))
        {
            (double speed, double limit) = joint.Motor ?? default;
            if (joint.IsSlider)
                Function<Slider>(library, "peer_slider")(_world, joint.Body0, joint.Body1, Numbers(joint.Frame));
            else
                hinge(_world, joint.Body0, joint.Body1, Numbers(joint.Frame), Numbers(joint.Frame0), Numbers(joint.Frame1), joint.Motor is null ? 0 : 1, speed, limit);
        }
    }

    private delegate IntPtr Creator(int substeps, double frequency, double[] gravity);

    private delegate void Body(IntPtr world, double[] pose, double mass, double[] inertia, double[] velocity);

    private delegate void Hinge(IntPtr world, int body0, int body1, double[] frame, double[] frame0, double[] frame1, int isDriven, double speed, double limit);

    private delegate void Slider(IntPtr world, int body0, int body1, double[] frame);

    private delegate void Stepper(IntPtr world, double dt);

    private delegate void Reader(IntPtr world, int body, double[] state);

    private delegate void Destroyer(IntPtr world);

    public void Step(double dt) => _step(_world, dt);

    public void Write(Bodies bodies)
    {
        var s = new double[13];
        for (int i = 0; i < bodies.Count; i++)
        {
            _read(_world, i, s);
            bodies.Poses[i] = new Pose(new Vector3d(s[0], s[1], s[2]), new Quaterniond(s[3], s[4], s[5], s[6]).Normalized());
            bodies.LinearVelocities[i] = new Vector3d(s[7], s[8], s[9]);
            bodies.AngularVelocities[i] = new Vector3d(s[10], s[11], s[12]);
        }
    }

    public void Dispose() => _destroy(_world);

    private static T Function<T>(IntPtr library, string name) => Marshal.GetDelegateForFunctionPointer<T>(NativeLibrary.GetExport(library, name));

    private static double[] Numbers(Pose p) => new[] { p.Position.X, p.Position.Y, p.Position.Z, p.Rotation.X, p.Rotation.Y, p.Rotation.Z, p.Rotation.W };
}
