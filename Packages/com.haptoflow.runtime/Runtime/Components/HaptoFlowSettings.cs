#nullable enable
using System;
using UnityEngine;
#if HAPTOFLOW_XR
using System.Collections.Generic;
using UnityEngine.XR;
#endif

namespace HaptoFlow
{
    /// <summary>Settings of a project. The asset created in Project Settings > HaptoFlow, and one named
    /// HaptoFlowSettings in a Resources folder, are found automatically; a script can set another before the first
    /// stylus is enabled.</summary>
    [CreateAssetMenu(menuName = "HaptoFlow/Settings", fileName = ResourceName, order = 2)]
    [HelpPage(HelpPages.Components + "haptoflow-settings")]
    public sealed class HaptoFlowSettings : ScriptableObject
    {
        internal const string ResourceName = "HaptoFlowSettings";

        [SerializeField, Tooltip("The model is the .haptoflow file that generates the vibration.")]
        private HapticModelAsset? model;

        [SerializeField, Tooltip("The quality chooses the tier of the model. Auto measures this machine and chooses " +
            "the most accurate tier that fits the budget. Sketch plays without a network, for slow machines.")]
        private HapticQuality quality = HapticQuality.Auto;

        [SerializeField, Range(0.01f, 1f), Tooltip("With the quality Auto, inference may take this share of the time " +
            "between two contact states, 0.01 to 1.")]
        private float budgetShare = 0.25f;

        [SerializeField, Tooltip("The update rate is the refresh rate of the headset, or of the screen, read when " +
            "the engine starts.")]
        private bool followDisplay = true;

        [SerializeField, Range(1f, 1000f), Tooltip("The update rate is the number of contact states per second. It " +
            "is used when Follow Display is off, or when the display does not report its rate.")]
        private float updateRateHz = (float)HapticEngineOptions.DefaultUpdateRateHz;

        [SerializeField, Range(0f, 1f), Tooltip("The safety ceiling is the largest magnitude of an output sample. 1 " +
            "is full scale.")]
        private float ceiling = 1f;

        [SerializeField, Min(1f), Tooltip("The full scale is the acceleration of an output sample of 1. A smaller " +
            "value gives a stronger output.")]
        private float fullScaleMps2 = (float)HapticEngineOptions.DefaultFullScaleMps2;

        [SerializeField, Tooltip("The material map assigns materials to objects by rules, in every scene. When it is " +
            "empty, only objects with a Haptic Surface are felt, and those that the map of a single scene matches.")]
        private HapticMaterialMap? materialMap;

        private static HaptoFlowSettings? active;

        // Unity loads preloaded assets before or after load methods run, so no load method may reset this field.
        private static HaptoFlowSettings? preloaded;

        /// <summary>The model; null where none is chosen.</summary>
        public HapticModelAsset? Model { get => model; set => model = value; }

        /// <summary>Selects the tier.</summary>
        public HapticQuality Quality { get => quality.OrStandard(); set => quality = value; }

        /// <summary>With the quality Auto, share of the time between two contact states that inference may take, above
        /// 0 to 1.</summary>
        public float BudgetShare { get => budgetShare; set => budgetShare = value; }

        /// <summary>True to start the engine with the refresh rate of the running headset, else of the screen, as its
        /// update rate. A later change of the display's rate takes effect after <see
        /// cref="Haptics.Restart"/>.</summary>
        public bool FollowDisplay { get => followDisplay; set => followDisplay = value; }

        /// <summary>Contact states per second, 1 to 10000; used where the display is not followed or does not report
        /// its rate.</summary>
        public float UpdateRateHz { get => updateRateHz; set => updateRateHz = value; }

        /// <summary>Limit of the absolute output samples, 0 to 1.</summary>
        public float Ceiling { get => ceiling; set => ceiling = value; }

        /// <summary>Full scale: the acceleration that is +-1 in the output, in m/s^2, above 0.</summary>
        public float FullScaleMps2 { get => fullScaleMps2; set => fullScaleMps2 = value; }

        /// <summary>Assigns materials to objects by rules, in every scene; null for none. Changes take effect at once,
        /// also during a touch.</summary>
        public HapticMaterialMap? MaterialMap { get => materialMap; set => materialMap = value; }

        /// <summary>The project's settings; defaults where the project has none. Changes take effect for engines that
        /// start afterwards (<see cref="Haptics.Restart"/>). Main thread.</summary>
        public static HaptoFlowSettings Active
        {
            get
            {
                if (active == null)
                {
                    active = FindProjectSettings?.Invoke();
                }
                if (active == null)
                {
                    active = preloaded;
                }
                if (active == null)
                {
                    active = Resources.Load<HaptoFlowSettings>(ResourceName);
                }
                if (active == null)
                {
                    active = CreateInstance<HaptoFlowSettings>();
                }
                return active;
            }
            set => active = value;
        }

        /// <summary>Finds the project's settings in the editor, where preloaded assets are not loaded; null in
        /// players.</summary>
        internal static Func<HaptoFlowSettings?>? FindProjectSettings { get; set; }

        /// <summary>Makes <see cref="Active"/> search for the settings again.</summary>
        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        internal static void Forget() => active = null;

        // A settings asset among the player's preloaded assets becomes active when Unity loads it.
        private void OnEnable()
        {
            if (preloaded == null && model != null)
            {
                preloaded = this;
            }
        }

        private void OnValidate() => quality = quality.OrStandard();
    }

    /// <summary>The refresh rate of the display, in Hz. Main thread; makes garbage.</summary>
    internal static class DisplayRate
    {
        private const double MinimumHz = 1.0;
        private const double MaximumHz = 1000.0;

        /// <summary>The rate of the running headset, else of the screen.</summary>
        /// <returns>False where neither reports a rate; <paramref name="hertz"/> is then 0.</returns>
        public static bool TryGet(out double hertz) => TryGetHeadset(out hertz) || TryGetScreen(out hertz);

        private static bool TryGetHeadset(out double hertz)
        {
#if HAPTOFLOW_XR
            var displays = new List<XRDisplaySubsystem>();
            SubsystemManager.GetSubsystems(displays);
            foreach (XRDisplaySubsystem display in displays)
            {
                if (display.running && display.TryGetDisplayRefreshRate(out float rate) && IsUsable(rate))
                {
                    hertz = rate;
                    return true;
                }
            }
#endif
            hertz = 0.0;
            return false;
        }

        private static bool TryGetScreen(out double hertz)
        {
            double rate = Screen.currentResolution.refreshRateRatio.value;
            hertz = IsUsable(rate) ? rate : 0.0;
            return hertz > 0.0;
        }

        private static bool IsUsable(double rate) => rate >= MinimumHz && rate <= MaximumHz;
    }
}
