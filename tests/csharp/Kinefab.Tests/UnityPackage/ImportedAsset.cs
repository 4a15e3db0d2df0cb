using System.Collections.Generic;
using System.Linq;
using KinefabUnity;
using KinefabUnity.Editing;
using UnityEditor.AssetImporters;
using Unity = UnityEngine;

namespace Kinefab.Tests.UnityPackage;

/// <summary>What an import leaves in the stand-ins' project.</summary>
internal sealed class ImportedAsset
{
    private ImportedAsset(AssetImportContext context, KinefabImporter importer) => (Context, Importer) = (context, importer);

    public AssetImportContext Context { get; }

    public KinefabImporter Importer { get; }

    public Unity.GameObject Root => (Unity.GameObject)Context.mainObject;

    public KinefabSource Source => Context.Objects.Values.OfType<KinefabSource>().Single();

    public IEnumerable<string> Codes => Source.Findings.Select(f => f.code);

    /// <summary>The identifiers of a kind, "meshes".</summary>
    public IEnumerable<string> Identifiers(string kind) => Context.Objects.Keys.Select(k => k.Identifier).Where(i => i.StartsWith(kind + "/", System.StringComparison.Ordinal));

    public static ImportedAsset Of(string path, KinefabSettings? settings = null, KinefabImporter? importer = null)
    {
        importer ??= new KinefabImporter();
        if (settings is not null)
            typeof(KinefabImporter).GetField("settings", System.Reflection.BindingFlags.Instance | System.Reflection.BindingFlags.NonPublic)!.SetValue(importer, settings);
        var context = new AssetImportContext(path);
        importer.assetPath = path;
        importer.OnImportAsset(context);
        return new ImportedAsset(context, importer);
    }
}
