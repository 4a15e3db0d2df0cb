using System;
using System.Collections.Generic;
using System.IO;
using System.Runtime.InteropServices;
using Kinefab.Dynamics;

namespace Kinefab.Bench.Peers;

/// <summary>
/// Other engines beside which this library is measured. They are no part of it: build.sh puts them into a folder that the environment variable
/// KINEFAB_PEERS names when the benchmarks are built and run; those that are not there are left out.
/// </summary>
internal static class PeerList
{
    /// <summary>The peers against which the others' times are divided.</summary>
    public const string Reference = "Jitter2, default";

    public const string Box3D = "Box3D, 4 substeps (default)";

    /// <summary>Those against which scenes of a single mechanism are held.</summary>
    public const string Ode = "ODE, WorldStep";

    /// <summary>Likewise.</summary>
    public const string FineBepu = "Bepu, 8 substeps, 120 Hz";

    /// <summary>Engine with settings, and how it takes a scene.</summary>
    public static IEnumerable<(string Name, Func<MultibodySystem, IPeer> Make)> All()
    {
#if JITTER2
        yield return (Reference, scene => new JitterPeer(scene, 1));
#endif
#if BEPU
        yield return ("Bepu, 8 iterations, 30 Hz", scene => new BepuPeer(scene, 8, 1, 30));
        yield return (FineBepu, scene => new BepuPeer(scene, 1, 8, 120));
#endif
        if (Library("box3d") is { } box3d)
        {
            yield return (Box3D, scene => new NativePeer(box3d, scene, 4, 0));
            yield return ("Box3D, 32 substeps, 480 Hz", scene => new NativePeer(box3d, scene, 32, 480));
        }

        if (Library("ode") is { } ode)
            yield return (Ode, scene => new NativePeer(ode, scene, 1, 0));
    }

    /// <summary>Engines that the tables have and that are not there.</summary>
    public static IEnumerable<string> Missing()
    {
#if !JITTER2
        yield return "Jitter2";
#endif
#if !BEPU
        yield return "Bepu";
#endif
        if (Library("box3d") is null)
            yield return "Box3D";
        if (Library("ode") is null)
            yield return "ODE";
    }

    private static IntPtr? Library(string engine)
    {
        string? folder = Environment.GetEnvironmentVariable("KINEFAB_PEERS");
        return folder != null && NativeLibrary.TryLoad(Path.Combine(folder, $"lib{engine}_peer.so"), out IntPtr library) ? library : null;
    }
}
