using System;
using System.Collections.Generic;
using UnityEngine;
using Object = UnityEngine.Object;

namespace UnityEditor
{
    public class AssetImporter : Object
    {
        private readonly Dictionary<SourceAssetIdentifier, Object> _remapped = new Dictionary<SourceAssetIdentifier, Object>();

        public string assetPath { get; internal set; }

        public bool importSettingsMissing { get; internal set; }

        public string userData { get; set; } = "";

        public static AssetImporter GetAtPath(string path) => AssetDatabase.Importers.TryGetValue(path, out AssetImporter found) ? found : null;

        public void AddRemap(SourceAssetIdentifier identifier, Object externalObject) => _remapped[identifier] = externalObject;

        public bool RemoveRemap(SourceAssetIdentifier identifier) => _remapped.Remove(identifier);

        public Dictionary<SourceAssetIdentifier, Object> GetExternalObjectMap() => new Dictionary<SourceAssetIdentifier, Object>(_remapped);

        public void SaveAndReimport()
        {
        }

        public struct SourceAssetIdentifier
        {
            public Type type;
            public string name;

            public SourceAssetIdentifier(Type type, string name) => (this.type, this.name) = (type, name);
        }
    }
}

namespace UnityEditor.AssetImporters
{
    [AttributeUsage(AttributeTargets.Class, Inherited = false)]
    public class ScriptedImporterAttribute : Attribute
    {
        public bool AllowCaching;

        public ScriptedImporterAttribute(int version, string ext) => (this.version, fileExtensions) = (version, new[] { ext });

        public int version { get; }

        public string[] fileExtensions { get; }
    }

    public abstract class ScriptedImporter : AssetImporter
    {
        public abstract void OnImportAsset(AssetImportContext ctx);

        public virtual bool SupportsRemappedAssetType(Type type) => false;
    }

    /// <summary>Refuses what makes Unity refuse an asset: one identifier twice, a second main object, an object that is not there.</summary>
    public class AssetImportContext
    {
        /// <summary>By class and identifier, as Unity's fileIDs are.</summary>
        internal readonly Dictionary<(Type Type, string Identifier), Object> Objects = new Dictionary<(Type, string), Object>();
        internal readonly HashSet<string> Sources = new HashSet<string>();
        internal readonly HashSet<string> Custom = new HashSet<string>();
        internal readonly List<string> Errors = new List<string>();
        internal readonly List<string> Warnings = new List<string>();

        internal AssetImportContext(string assetPath) => this.assetPath = assetPath;

        public string assetPath { get; }

        public Object mainObject { get; private set; }

        public void AddObjectToAsset(string identifier, Object obj)
        {
            if (string.IsNullOrEmpty(identifier) || obj == null)
            {
                throw new ArgumentNullException(nameof(obj));
            }

            if (!Objects.TryAdd((obj.GetType(), identifier), obj))
            {
                throw new InvalidOperationException($"Identifier uniqueness violation: {identifier}.");
            }
        }

        public void AddObjectToAsset(string identifier, Object obj, Texture2D thumbnail) => AddObjectToAsset(identifier, obj);

        public void SetMainObject(Object obj)
        {
            if (mainObject != null)
            {
                throw new InvalidOperationException("The asset has a main object.");
            }

            mainObject = Objects.ContainsValue(obj) ? obj : throw new InvalidOperationException("It is not of the asset.");
        }

        public void GetObjects(List<Object> objects)
        {
            objects.Clear();
            objects.AddRange(Objects.Values);
        }

        public void DependsOnSourceAsset(string path) => Sources.Add(string.IsNullOrEmpty(path) ? throw new ArgumentNullException(nameof(path)) : path);

        public void DependsOnCustomDependency(string dependency) => Custom.Add(string.IsNullOrEmpty(dependency) ? throw new ArgumentNullException(nameof(dependency)) : dependency);

        public void LogImportError(string msg, Object obj = null) => Errors.Add(msg);

        public void LogImportWarning(string msg, Object obj = null) => Warnings.Add(msg);
    }
}
