// Two wheels on a moving frame, 1,000 steps: the driven one keeps its ratio, whether moved or driven.
// Their angles are worked out here from the poses, by rotation matrices and not by the script's own formulas.
using System;
using System.Globalization;
using System.Reflection;
using Kinefab;
using UnityEngine;

public static partial class GearPair
{
    private const double Ratio = -2.5, Offset = 17;

    public static int Main(string[] arguments)
    {
        CultureInfo.CurrentCulture = CultureInfo.InvariantCulture;
        string how = arguments[0];
        Predicate<string> ends = word => how.EndsWith(word, StringComparison.Ordinal);
        double worst = how.Contains("link") ? Links.Run(how) : ends("turns") ? Several.Turns(how) : ends("terms") ? Several.Terms() : ends("wakes") ? Several.Wakes() : ends("slide") ? Slide.Run(how) : ends("screw") ? Slide.Screw() : how.StartsWith("free") ? Release.Run(how) : Run(how);
        Console.WriteLine(worst.ToString("R"));
        return 0;
    }

    private static double Run(string how)
    {
        var frame = Body("Frame", true);
        var first = Body("First", false);
        var second = Body("Second", how.EndsWith("moved"));
        var source = Hinge(first, frame, new Vector3(0, 0, 1), new Vector3(0.1f, 0.2f, 0.3f));
        Joint driven = how.EndsWith("configurable") ? (Joint)Configurable(second, frame) : Hinge(second, frame, new Vector3(0, 1, 0), new Vector3(-0.1f, 0.2f, 0.3f));
        var coupling = second.AddComponent<KinefabCoupling>();
        coupling.driven = driven;
        coupling.drivenCoordinate = how.EndsWith("configurable") ? KinefabCoupling.Coordinate.AngularX : KinefabCoupling.Coordinate.Angle;
        coupling.terms = new[] { new KinefabCoupling.Term { joint = source, coordinate = KinefabCoupling.Coordinate.Angle, ratio = (float)Ratio } };
        coupling.offset = (float)Offset;
        if (how.StartsWith("late"))
        {
            Call(coupling, "Awake"); // disabled in the prefab, and enabled while the source stands elsewhere
            Follow(first, frame, Turn(new double[] { 0, 0, 1 }, 50), source);
            Call(coupling, "OnEnable");
        }

        Call(coupling, "Start");
        double worst = 0;
        for (int i = how.StartsWith("late") ? 56 : 1; i <= 1000; i++)
        {
            if (i == 500 && how.StartsWith("recompiled"))
            {
                Recompiled.Run(coupling);
            }

            double q = 0.9 * i; // two and a half turns, six of the other
            frame.transform.rotation = Turn(new double[] { 0, 0.6, 0.8 }, 0.3 * i);
            frame.transform.position = new Vector3(0.001f * i, 0, -0.002f * i);
            Follow(first, frame, Turn(new double[] { 0, 0, 1 }, q), source);
            Call(coupling, "FixedUpdate");
            if (how.EndsWith("hinge"))
            {
                var hinge = (HingeJoint)driven;
                if (!hinge.useSpring || hinge.useMotor || hinge.spring.spring <= 0)
                {
                    throw new InvalidOperationException("not driven");
                }

                Follow(second, frame, Turn(new double[] { 0, 1, 0 }, hinge.spring.targetPosition), driven);
            }
            else if (how.EndsWith("configurable"))
            {
                var joint = (ConfigurableJoint)driven;
                var goal = joint.targetRotation; // of the connected frame in the own one, along the joint's axes: the inverse turn
                if (joint.angularXDrive.positionSpring <= 0 || joint.angularXDrive.maximumForce <= 0)
                {
                    throw new InvalidOperationException("not driven");
                }

                Follow(second, frame, new Quaternion(0, -goal.x, 0, goal.w), driven);
            }

            double angle = Angle(frame.transform.rotation, second.transform.rotation);
            double off = angle - (Ratio * q + Offset);
            worst = Math.Max(worst, Math.Abs(off - 360 * Math.Round(off / 360)));
            worst = Math.Max(worst, 1000 * Apart(second, frame, driven));
        }

        return worst;
    }

    private static GameObject Body(string name, bool isKinematic)
    {
        var made = new GameObject(name);
        made.AddComponent<Rigidbody>().isKinematic = isKinematic;
        return made;
    }

    private static HingeJoint Hinge(GameObject own, GameObject connected, Vector3 axis, Vector3 at)
    {
        own.transform.position = at;
        var joint = own.AddComponent<HingeJoint>();
        joint.autoConfigureConnectedAnchor = false;
        joint.connectedBody = connected.GetComponent<Rigidbody>();
        joint.axis = axis;
        joint.anchor = new Vector3(0.01f, 0.02f, 0.03f);
        joint.connectedAnchor = new Vector3(at.x + 0.01f, at.y + 0.02f, at.z + 0.03f);
        joint.useMotor = true;
        return joint;
    }

    private static ConfigurableJoint Configurable(GameObject own, GameObject connected)
    {
        own.transform.position = new Vector3(-0.1f, 0.2f, 0.3f);
        var joint = own.AddComponent<ConfigurableJoint>();
        joint.autoConfigureConnectedAnchor = false;
        joint.connectedBody = connected.GetComponent<Rigidbody>();
        joint.axis = new Vector3(0, 1, 0);
        joint.secondaryAxis = new Vector3(0, 0, 1);
        joint.anchor = new Vector3(0.01f, 0.02f, 0.03f);
        joint.connectedAnchor = new Vector3(-0.09f, 0.22f, 0.33f);
        return joint;
    }

    private static void Call(KinefabCoupling coupling, string message)
    {
        typeof(KinefabCoupling).GetMethod(message, BindingFlags.Instance | BindingFlags.NonPublic).Invoke(coupling, null);
    }

    private static Quaternion Turn(double[] axis, double degrees)
    {
        double half = degrees * Math.PI / 360, s = Math.Sin(half);
        return new Quaternion((float)(s * axis[0]), (float)(s * axis[1]), (float)(s * axis[2]), (float)Math.Cos(half));
    }

    private static double[,] Matrix(Quaternion q)
    {
        double x = q.x, y = q.y, z = q.z, w = q.w;
        return new[,]
        {
            { 1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w) },
            { 2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w) },
            { 2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y) },
        };
    }

    private static Quaternion Times(Quaternion a, Quaternion b)
    {
        return new Quaternion(
            a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
            a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
            a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w,
            a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z);
    }

    // The own body turned against the frame, with the anchors together.
    private static void Follow(GameObject own, GameObject frame, Quaternion turn, Joint joint)
    {
        own.transform.rotation = Times(frame.transform.rotation, turn);
        double[] anchor = Point(own.transform.rotation, joint.anchor), other = Point(frame.transform.rotation, joint.connectedAnchor);
        Vector3 at = frame.transform.position;
        own.transform.position = new Vector3((float)(at.x + other[0] - anchor[0]), (float)(at.y + other[1] - anchor[1]), (float)(at.z + other[2] - anchor[2]));
    }

    private static double[] Point(Quaternion q, Vector3 v)
    {
        double[,] m = Matrix(q);
        return new[] { m[0, 0] * v.x + m[0, 1] * v.y + m[0, 2] * v.z, m[1, 0] * v.x + m[1, 1] * v.y + m[1, 2] * v.z, m[2, 0] * v.x + m[2, 1] * v.y + m[2, 2] * v.z };
    }

    private static double Apart(GameObject own, GameObject frame, Joint joint)
    {
        double[] a = Point(own.transform.rotation, joint.anchor), b = Point(frame.transform.rotation, joint.connectedAnchor);
        Vector3 p = own.transform.position, o = frame.transform.position;
        return Math.Abs(p.x + a[0] - o.x - b[0]) + Math.Abs(p.y + a[1] - o.y - b[1]) + Math.Abs(p.z + a[2] - o.z - b[2]);
    }

    // About +Y of the frame: where the own X axis points.
    private static double Angle(Quaternion frame, Quaternion own)
    {
        double[,] f = Matrix(frame), m = Matrix(own);
        double x = 0, z = 0;
        for (int i = 0; i < 3; i++)
        {
            x += f[i, 0] * m[i, 0];
            z += f[i, 2] * m[i, 0];
        }

        return Math.Atan2(-z, x) * 180 / Math.PI;
    }
}
