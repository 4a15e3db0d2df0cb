using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using System.Reflection;
using KinefabUnity;
using NUnit.Framework;
using Unity = UnityEngine;

namespace Kinefab.Tests.UnityPackage;

/// <summary>Holds what the package made against a prefab, every field of every component; one that it does not know is a fault.</summary>
internal sealed class PrefabComparison
{
    // Of a field's last digit: .kinefab and .prefab are rounded apart.
    private const double Relative = 2e-6;
    private const double Least = 2e-12;

    // About the file, of the editor's own, or at the default of a new component.
    private static readonly HashSet<string> LeftOut =
    [
        "m_ObjectHideFlags", "m_CorrespondingSourceObject", "m_PrefabInstance", "m_PrefabAsset", "m_GameObject", "serializedVersion",
        "m_IncludeLayers", "m_ExcludeLayers", "m_LayerOverridePriority", "m_ProvidesContacts", "m_Icon", "m_NavMeshLayer", "m_StaticEditorFlags", "m_Component",
        "m_ConstrainProportionsScale", "m_Children", "m_Father", "m_RootOrder", "m_LocalEulerAnglesHint",
        "m_CastShadows", "m_ReceiveShadows", "m_DynamicOccludee", "m_StaticShadowCaster", "m_MotionVectors", "m_LightProbeUsage", "m_ReflectionProbeUsage",
        "m_RayTracingMode", "m_RayTraceProcedural", "m_RenderingLayerMask", "m_RendererPriority", "m_StaticBatchInfo", "m_StaticBatchRoot", "m_ProbeAnchor",
        "m_LightProbeVolumeOverride", "m_ScaleInLightmap", "m_ReceiveGI", "m_PreserveUVs", "m_IgnoreNormalsForChartDetection", "m_ImportantGI",
        "m_StitchLightmapSeams", "m_SelectedEditorRenderState", "m_MinimumChartSize", "m_AutoUVMaxDistance", "m_AutoUVMaxAngle", "m_LightmapParameters",
        "m_Script", "m_Name", "m_EditorHideFlags", "m_EditorClassIdentifier", "m_SortingLayerID", "m_SortingLayer", "m_SortingOrder", "m_AdditionalVertexStreams", "m_AnimatePhysics", "m_CullingType", "m_WrapMode", "ArticulationBody.m_Enabled",
    ];

    // What scripts call otherwise than files.
    private static readonly Dictionary<string, string> Names = new()
    {
        ["Rigidbody.m_Drag"] = "linearDamping",
        ["Rigidbody.m_AngularDrag"] = "angularDamping",
        ["m_InertiaRotation"] = "inertiaTensorRotation",
        ["m_ImplicitCom"] = "automaticCenterOfMass",
        ["m_ImplicitTensor"] = "automaticInertiaTensor",
        ["m_Interpolate"] = "interpolation",
        ["Rigidbody.m_CollisionDetection"] = "collisionDetectionMode",
        ["m_TagString"] = "tag",
        ["m_IsActive"] = "activeSelf",
        ["m_ArticulationJointType"] = "jointType",
        ["m_LinearX"] = "linearLockX",
        ["m_LinearY"] = "linearLockY",
        ["m_LinearZ"] = "linearLockZ",
        ["m_SwingY"] = "swingYLock",
        ["m_SwingZ"] = "swingZLock",
        ["m_Twist"] = "twistLock",
    };

    private readonly PrefabFile prefab;
    private readonly Dictionary<string, string> assets;
    private readonly Dictionary<string, string> paths = [];

    public PrefabComparison(string path)
    {
        prefab = PrefabFile.Read(path);
        string folder = path[..^".prefab".Length];
        assets = System.IO.Directory.Exists(folder) ? PrefabFile.Assets(folder) : [];
    }

    /// <summary>How many fields were compared.</summary>
    public int Compared { get; private set; }

    public void Same(Unity.GameObject root)
    {
        string top = prefab.Documents.Single(d => d.Value.Class == "Transform" && d.Value["m_Father.fileID"] == "0").Key;
        Index(top, "");
        SameObject(top, root, isRoot: true);
    }

    // Objects by their paths of names, so that references can be compared.
    private void Index(string transform, string path)
    {
        string owner = prefab.Documents[transform]["m_GameObject.fileID"];
        foreach (string component in prefab.Documents[owner].List("m_Component").Prepend(owner))
            paths[component] = path;
        foreach (string child in prefab.Documents[transform].List("m_Children"))
            Index(child, $"{path}/{prefab.Documents[prefab.Documents[child]["m_GameObject.fileID"]]["m_Name"]}");
    }

    private void SameObject(string transform, Unity.GameObject to, bool isRoot)
    {
        PrefabFile.Record place = prefab.Documents[transform], own = prefab.Documents[place["m_GameObject.fileID"]];
        string at = paths[transform];
        foreach (string field in own.Fields.Keys.Where(f => !IsLeftOut(own.Class, f) && !(isRoot && f == "m_Name")))
            Check(own, field, to, at);
        string[] components = [.. own.List("m_Component")];
        // What moves an import is none of a prefab's, which needs no package.
        Assert.That(to.Components.Where(c => c is not (KinefabMechanism or KinefabBody)).Select(Class).Order(StringComparer.Ordinal), Is.EqualTo(components.Select(c => prefab.Documents[c].Class).Order(StringComparer.Ordinal)), at);
        foreach (IGrouping<string, string> kind in components.GroupBy(c => prefab.Documents[c].Class))
        {
            foreach ((string from, Unity.Component component) in kind.Zip(to.Components.Where(c => c is not (KinefabMechanism or KinefabBody) && Class(c) == kind.Key)))
            {
                PrefabFile.Record record = prefab.Documents[from];
                foreach (string field in record.Fields.Keys.Where(f => !IsLeftOut(record.Class, f)))
                    Check(record, field, component, $"{at} {record.Class}");
            }
        }

        Dictionary<string, string> children = place.List("m_Children").ToDictionary(c => prefab.Documents[prefab.Documents[c]["m_GameObject.fileID"]]["m_Name"]);
        Assert.That(to.transform.Children.Select(c => c.name), Is.EquivalentTo(children.Keys), at);
        foreach (Unity.Transform child in to.transform.Children)
            SameObject(children[child.name], child.gameObject, isRoot: false);
    }

    private static bool IsLeftOut(string kind, string field)
    {
        string first = field.Split('.')[0];
        return LeftOut.Contains(first) || LeftOut.Contains($"{kind}.{first}") || field.EndsWith(".serializedVersion", StringComparison.Ordinal);
    }

    private void Check(PrefabFile.Record record, string field, object to, string at)
    {
        string value = record[field];
        Compared++;
        at = $"{at}.{field}";
        string[] parts = field.Split('.');
        switch (parts[0])
        {
            case "m_ConnectedBody" or "m_ConnectedArticulationBody":
                var joint = (Unity.Joint)to;
                Unity.Component? other = parts[0] == "m_ConnectedBody" ? joint.connectedBody : joint.connectedArticulationBody;
                Assert.That(other == null! ? null : Path(other.transform), Is.EqualTo(value == "0" ? null : paths[value]), at);
                return;
            case "driven" or "drivenArticulationBody":
                SameReference(value, (Unity.Component?)Member(to, record.Class, parts[0], at), at);
                return;
            case "terms" when parts.Length > 2:
                KinefabCoupling.Term term = ((KinefabCoupling)to).terms[int.Parse(parts[1], CultureInfo.InvariantCulture)];
                object? of = Member(term, record.Class, parts[2], at);
                if (parts[2] is "joint" or "articulationBody")
                    SameReference(value, (Unity.Component?)of, at);
                else
                    Assert.That(Number(of!), Is.EqualTo(Expected(value)).Within(Relative * Math.Abs(Expected(value)) + Least), at);
                return;
            case "m_ConnectedAnchor" when record["m_AutoConfigureConnectedAnchor"] == "1":
                return; // Unity's own value
            case "m_Mesh":
                if (parts[1] == "guid")
                    MeshComparison.Same(assets[value], to is Unity.MeshFilter filter ? filter.sharedMesh : ((Unity.MeshCollider)to).sharedMesh, at);
                return;
            case "m_Materials":
                if (parts.Length == 3 && parts[2] == "guid")
                    Compared += MaterialComparison.Same(assets[value], assets, ((Unity.Renderer)to).sharedMaterials[int.Parse(parts[1], CultureInfo.InvariantCulture)], at);
                return;
            case "m_Animation":
                if (parts[1] == "guid")
                    ClipComparison.Same(assets[value], ((Unity.Animation)to).clip, at);
                return;
            case "m_Animations":
                if (parts.Length == 3 && parts[2] == "guid")
                    ClipComparison.Same(assets[value], ((Unity.Animation)to).Clips[int.Parse(parts[1], CultureInfo.InvariantCulture)], at);
                return;
            case "m_Material":
                if (parts[1] == "guid")
                    PhysicsMaterialComparison.Same(assets[value], ((Unity.Collider)to).sharedMaterial, at);
                else if (value == "0")
                    Assert.That(((Unity.Collider)to).sharedMaterial == null!, at);
                return;
            case "m_XDrive" when record.Class == "ArticulationBody" && parts.Length == 2 && parts[1] == "targetVelocity" && record["m_ArticulationJointType"] == "1":
                // The prefab is of an editor that runs slides backwards; the stand-ins are of one that does not.
                Assert.That(Number(((Unity.ArticulationBody)to).xDrive.targetVelocity), Is.EqualTo(-double.Parse(value, CultureInfo.InvariantCulture)).Within(1e-6), at);
                return;
        }

        object? found = to;
        if (value.Length == 0 && found is not string && record.Fields.Keys.Any(f => f.StartsWith(field + ".", StringComparison.Ordinal)))
            return; // a block, whose fields follow
        foreach (string part in parts)
            found = Member(found!, record.Class, part, at);
        if (found is string text)
            Assert.That(text, Is.EqualTo(value), at);
        else
            Assert.That(Number(found!), Is.EqualTo(Expected(value)).Within(Math.Abs(Expected(value)) < 1e38 ? Relative * Math.Abs(Expected(value)) + Least : 0), at);
    }

    private void SameReference(string value, Unity.Component? found, string at)
    {
        Assert.That(found == null! ? null : Path(found.transform), Is.EqualTo(value == "0" ? null : paths[value]), at);
        if (found is Unity.Joint joint)
        {
            string[] same = [.. prefab.Documents.Where(d => d.Value.Class == joint.GetType().Name && paths[d.Key] == paths[value]).Select(d => d.Key)];
            Assert.That(Array.IndexOf(same, value), Is.EqualTo(Array.FindIndex(found.gameObject.Components.Where(c => c.GetType() == joint.GetType()).ToArray(), c => ReferenceEquals(c, joint))), at);
        }
    }

    private static string Class(Unity.Component component) => component is Unity.MonoBehaviour ? "MonoBehaviour" : component.GetType().Name;

    private static double Expected(string value) => value == "Infinity" ? double.PositiveInfinity : (float)double.Parse(value, CultureInfo.InvariantCulture);

    private static double Number(object found) => found switch
    {
        bool flag => flag ? 1 : 0,
        Enum word => Convert.ToInt32(word, CultureInfo.InvariantCulture),
        _ => Convert.ToDouble(found, CultureInfo.InvariantCulture),
    };

    private static object? Member(object of, string kind, string part, string at)
    {
        string plain = part.StartsWith("m_", StringComparison.Ordinal) ? char.ToLowerInvariant(part[2]) + part[3..] : part;
        string name = Names.GetValueOrDefault($"{kind}.{part}") ?? Names.GetValueOrDefault(part, plain);
        MemberInfo? member = (MemberInfo?)of.GetType().GetProperty(name) ?? of.GetType().GetField(name);
        Assert.That(member, Is.Not.Null, $"{at}: Unity has no {name}");
        return member is PropertyInfo property ? property.GetValue(of) : ((FieldInfo)member!).GetValue(of);
    }

    private static string Path(Unity.Transform of) => of.parent == null! ? "" : $"{Path(of.parent)}/{of.name}";
}
