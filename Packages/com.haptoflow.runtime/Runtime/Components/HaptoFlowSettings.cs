#nullable enable
using System;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>What a project renders with. The asset that Project Settings > HaptoFlow makes, and one named
    /// HaptoFlowSettings in a Resources folder, are found by themselves; another can be set before the first stylus
    /// wakes.</summary>
    [CreateAssetMenu(menuName = "HaptoFlow/Settings", fileName = ResourceName, order = 2)]
    [HelpURL(HelpPages.Components + "haptoflow-settings")]
    public sealed class HaptoFlowSettings : ScriptableObject
    {
        internal const string ResourceName = "HaptoFlowSettings";

        [SerializeField, Tooltip("The .haptoflow model.")]
        private HapticModelAsset? model;

        [SerializeField, Tooltip("Auto measures this machine and takes the most accurate tier that fits the budget.")]
        private HapticQuality quality = HapticQuality.Auto;

        [SerializeField, Range(0.01f, 1f)]
        [Tooltip("Auto: share of the time between two contact states that inference may take.")]
        private float budgetShare = 0.25f;

        [SerializeField, Tooltip("The update rate is the headset's, or the screen's, where the display says it.")]
        private bool followDisplay = true;

        [SerializeField, Range(1f, 1000f)]
        [Tooltip("Contact states a second, in Hz: counts where the display is not followed, or does not say its rate.")]
        private float updateRateHz = 72f;

        [SerializeField, Range(0f, 1f), Tooltip("Safety: no output sample is above this, whatever happens.")]
        private float ceiling = 1f;

        [SerializeField, Min(1f), Tooltip("Acceleration that is full scale in the output, in m/s^2.")]
        private float fullScaleMps2 = (float)HapticEngineOptions.DefaultFullScaleMps2;

        [SerializeField, Tooltip("Says by rules which object is which material; empty for Haptic Surfaces alone.")]
        private HapticMaterialMap? materialMap;

        private static HaptoFlowSettings? active;

        // Preloaded assets wake before load methods run or after them: no load method forgets this one.
        private static HaptoFlowSettings? preloaded;

        /// <summary>The model; null where none is chosen.</summary>
        public HapticModelAsset? Model
        {
            get => model;
            set => model = value;
        }

        /// <summary>Which tier generates.</summary>
        public HapticQuality Quality
        {
            get => quality;
            set => quality = value;
        }

        /// <summary>Above 0 to 1.</summary>
        public float BudgetShare
        {
            get => budgetShare;
            set => budgetShare = value;
        }

        /// <summary>An engine that starts takes the refresh rate of the running headset, else of the screen, as its
        /// update rate. A display that changes its rate later is followed after
        /// <see cref="Haptics.Restart"/>.</summary>
        public bool FollowDisplay
        {
            get => followDisplay;
            set => followDisplay = value;
        }

        /// <summary>Contact states a second, 1 to 10000: counts where the display is not followed, or does not say its
        /// rate.</summary>
        public float UpdateRateHz
        {
            get => updateRateHz;
            set => updateRateHz = value;
        }

        /// <summary>0 to 1.</summary>
        public float Ceiling
        {
            get => ceiling;
            set => ceiling = value;
        }

        /// <summary>Acceleration that is +-1 in the output, in m/s^2, above 0.</summary>
        public float FullScaleMps2
        {
            get => fullScaleMps2;
            set => fullScaleMps2 = value;
        }

        /// <summary>Says by rules which object is which material, in every scene; null for none. Counts at once, also
        /// when it is changed while something is touched.</summary>
        public HapticMaterialMap? MaterialMap
        {
            get => materialMap;
            set => materialMap = value;
        }

        /// <summary>The project's settings; built-in ones where the project has none. What is set here counts for
        /// engines that start afterwards (<see cref="Haptics.Restart"/>). Main thread.</summary>
        public static HaptoFlowSettings Active
        {
            get
            {
                if (active == null)
                {
                    active = OfProject?.Invoke();
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
        internal static Func<HaptoFlowSettings?>? OfProject { get; set; }

        /// <summary>Nothing is active until somebody asks again.</summary>
        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        internal static void Forget() => active = null;

        // A settings asset among the player's preloaded assets takes effect by being there.
        private void OnEnable()
        {
            if (preloaded == null && model != null)
            {
                preloaded = this;
            }
        }
    }
}
