using System;
using System.Collections.Generic;
using System.Linq;
using KinefabUnity;
using UnityEngine;

namespace Kinefab.Tests.UnityPackage;

/// <summary>
/// A mechanism of the package in play, on the stand-ins: what every runtime must answer alike. It is compiled for mono and for machine code too, so it
/// refers to nothing of the tests.
/// </summary>
internal static class PackageRun
{
    /// <summary>What its freedoms and parts show while all freedoms move, degrees and metres.</summary>
    /// <param name="path">Of the scene's file.</param>
    public static IEnumerable<double> Numbers(string path)
    {
        Player.Play(true);
        var findings = new List<KinefabFinding>();
        GameObject root = KinefabScene.Instantiate(path, null, new KinefabSettings(), findings);
        KinefabMechanism mechanism = root.GetComponent<KinefabMechanism>();
        var values = new double[mechanism.Freedoms.Count];
        var numbers = new List<double> { findings.Count };
        for (int frame = 1; frame <= 100; frame++)
        {
            for (int i = 0; i < values.Length; i++)
                values[i] = mechanism.Freedoms[i].Low + (mechanism.Freedoms[i].High - mechanism.Freedoms[i].Low) * ((frame + 7 * i) % 50) / 50;
            mechanism.Set(values);
            Player.Frame();
            numbers.Add((int)mechanism.Last.Stop);
            numbers.AddRange(Enumerable.Range(0, values.Length).Select(mechanism.Value));
            foreach (Rigidbody body in root.GetComponentsInChildren<Rigidbody>(true))
            {
                body.Arrive();
                Vector3 at = body.transform.position;
                Quaternion turn = body.transform.rotation;
                numbers.AddRange(new double[] { at.x, at.y, at.z, turn.x, turn.y, turn.z, turn.w });
            }

            if (frame == 50)
                Player.ReloadDomain();
        }

        UnityEngine.Object.DestroyImmediate(root);
        Player.Play(false);
        return numbers;
    }
}
