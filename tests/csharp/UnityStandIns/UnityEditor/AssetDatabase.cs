using System;
using System.Collections.Generic;
using UnityEngine;
using Object = UnityEngine.Object;

namespace UnityEditor
{
    public sealed class AssetDatabase
    {
        internal static readonly Dictionary<string, AssetImporter> Importers = new Dictionary<string, AssetImporter>();
        internal static readonly Dictionary<string, Object[]> Assets = new Dictionary<string, Object[]>();
        internal static readonly Dictionary<string, Hash128> Dependencies = new Dictionary<string, Hash128>();

        public static Object[] LoadAllAssetsAtPath(string assetPath) => Assets.TryGetValue(assetPath, out Object[] found) ? found : Array.Empty<Object>();

        public static T LoadAssetAtPath<T>(string assetPath) where T : Object => Array.Find(LoadAllAssetsAtPath(assetPath), o => o is T) as T;

        public static string GetAssetPath(Object assetObject)
        {
            foreach (KeyValuePair<string, Object[]> asset in Assets)
            {
                if (Array.IndexOf(asset.Value, assetObject) >= 0)
                {
                    return asset.Key;
                }
            }

            return "";
        }

        public static void CreateAsset(Object asset, string path) => Assets[path] = new[] { asset };

        public static string CreateFolder(string parentFolder, string newFolderName) => $"{parentFolder}/{newFolderName}";

        public static bool DeleteAsset(string path) => Assets.Remove(path);

        public static string GenerateUniqueAssetPath(string path) => path;

        public static bool WriteImportSettingsIfDirty(string path) => true;

        public static void ImportAsset(string path, ImportAssetOptions options = ImportAssetOptions.Default)
        {
        }

        /// <summary>How often the project was looked through.</summary>
        internal static int Refreshed { get; private set; }

        public static void Refresh() => Refreshed++;

        public static bool IsAssetImportWorkerProcess() => false;

        /// <summary>Another one after each import.</summary>
        public static Hash128 GetAssetDependencyHash(string path) =>
            Hash128.Compute(string.Join(" ", Array.ConvertAll(LoadAllAssetsAtPath(path), System.Runtime.CompilerServices.RuntimeHelpers.GetHashCode)));

        public static void RegisterCustomDependency(string dependency, Hash128 hashOfValue) => Dependencies[dependency] = hashOfValue;
    }

    public sealed class EditorApplication
    {
        public delegate void CallbackFunction();

        /// <summary>Called once, when the editor has time.</summary>
        public static CallbackFunction delayCall { get; set; }

        internal static void Idle()
        {
            CallbackFunction calls = delayCall;
            delayCall = null;
            calls?.Invoke();
        }
    }

    [Flags]
    public enum ImportAssetOptions
    {
        Default = 0,
        ForceUpdate = 1,
    }

    public static class Unwrapping
    {
        public static void GenerateSecondaryUVSet(Mesh src) => src.uv2 = new Vector2[src.vertexCount];
    }

    public static class FileUtil
    {
        public static string GetPhysicalPath(string path) => path;
    }

    public sealed partial class EditorUtility
    {
        internal static readonly List<float> Progress = new List<float>();

        internal static bool IsBarShown { get; private set; }

        public static void DisplayProgressBar(string title, string info, float progress)
        {
            IsBarShown = true;
            Progress.Add(progress);
        }

        public static void ClearProgressBar() => IsBarShown = false;
    }

    [AttributeUsage(AttributeTargets.Method)]
    public class InitializeOnLoadMethodAttribute : Attribute
    {
    }
}

namespace UnityEngine
{
    public struct Hash128 : IEquatable<Hash128>
    {
        private string _of;

        public static Hash128 Compute(string data) => new Hash128 { _of = data };

        public bool Equals(Hash128 other) => _of == other._of;

        public override string ToString() => _of;
    }
}
